"""Tables that engines look the sky up in: mappings, how they are made, and code that reads them."""
