"""What a world is in numbers and plots, and its light in given directions."""
