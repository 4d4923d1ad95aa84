"""A world in numbers and plots, and its light in given directions."""
