"""Image files: the one place that knows OpenImageIO."""
