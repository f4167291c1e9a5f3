"""Results: one frozen class per analysis. No files, no figures."""
