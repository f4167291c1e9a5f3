"""Small systems integrated side by side in vector registers, with tangents."""
