"""Lights of the night beside the sun."""
