"""Tables that rays look up: each file holds one, with its mapping, build and lookup."""
