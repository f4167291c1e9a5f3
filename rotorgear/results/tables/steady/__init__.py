"""Tables of steady states and small motions about them: statics, modes, speeds, responses."""
