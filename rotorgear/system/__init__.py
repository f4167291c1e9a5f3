"""The system: nodes, degrees of freedom and sparse M, C, G, K of a model."""
