"""Studies that take longer than a case: folds and jumps, layouts, synthetic rigs, casings and wheels in 3D."""
