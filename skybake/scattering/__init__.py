"""All orders of scattering: an atmosphere's tables, and the light that rays gather by them."""
