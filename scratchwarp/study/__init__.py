"""Error against what is known: reports of fits to measured BRDFs. Sweeps of error against time are not here yet.

Files:
    fit_candidates  a stencil model and its rivals, fitted to one measurement
    fit_metrics     how far each is off, by scikit-image where it is installed
    fit_pictures    BRDFs unfolded into pictures, slices as charts
    fit_report      all of it as a folder with an HTML page
"""
