"""Steady states and small motions about them: statics, modes, speeds, responses."""
