"""Rules of rotor standards, applied to what the analyses say."""
