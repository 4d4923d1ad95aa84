"""Pixels to directions and back: no physics, only where a map looks."""
