"""What is wrong with a model: every problem with its address."""
