"""Measured BRDFs."""
