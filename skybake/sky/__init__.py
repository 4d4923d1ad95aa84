"""Radiance from a direction, for an observer and sources of light."""
