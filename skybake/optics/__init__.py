"""Physics in numpy: what each constituent of the air does to light."""
