"""Straight rays through the air: geometry, density, shells, samples."""
