"""Image files: the only package that uses OpenImageIO."""
