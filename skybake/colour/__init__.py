"""Spectra to linear RGB, and the light that an RGB of one stands for."""
