"""Scripts that people run and copy: one task a file, each with main(argv)."""
