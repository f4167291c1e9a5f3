"""What several analyses share: arguments, clock, notes, places, points."""
