"""A page on this machine in which a model is edited, seen and computed; see docs/app.md."""
