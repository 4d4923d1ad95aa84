"""The one physical answer: radiance from a direction, for an observer and a sun."""
