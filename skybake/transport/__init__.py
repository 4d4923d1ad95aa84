"""Straight rays through an atmosphere: geometry, density, shells, samples."""
