"""Error against time: references, metrics, sweeps and their report. Nothing is here yet."""
