"""What follows from the parts: train, contacts, phases, torque flow, stiffness."""
