"""Parameter sweeps: bifurcation diagrams, Lyapunov exponents, response types."""
