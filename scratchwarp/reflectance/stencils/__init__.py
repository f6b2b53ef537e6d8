"""Highlight stencils."""
