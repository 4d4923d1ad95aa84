"""Physically based HDR sky maps for any sun, altitude and planet."""
