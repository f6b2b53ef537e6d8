"""What people look at while they work: pyvista, one file per thing looked at."""
