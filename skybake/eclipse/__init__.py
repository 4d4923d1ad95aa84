"""A moon in front of the sun, and the light that it leaves, from place to place."""
