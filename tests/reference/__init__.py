"""Tests of the path tracer that the fast solver is judged by."""
