"""Elements: mass, damping, gyroscopic and stiffness matrices of one kind of part each."""
