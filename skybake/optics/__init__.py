"""Physics in numpy: what each constituent of an atmosphere does to light."""
