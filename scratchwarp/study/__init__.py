"""What accuracy costs: sweeps of error against time, and reports of fits to measured BRDFs.

``study.sweep(scene) -> Report``; ``report.pareto()``; ``report.write("out/")``.

Files:
    sweeping        renders a scene at many settings and compares with a reference, within a budget
    study           what one sweep knows: its settings, measurements, images and reference
    shots           one scene rendered at many settings, with what the renders share kept
    reference       what the reference is made with, and how it is made cheaper for a budget
    guess, order    how long the next render will take; which setting comes next
    measurement     one rendering, and the file of all of them
    measures        relative mean square error and FLIP; table_error: of the tables themselves
    calibration     prices of units of work on this machine (plan/cost/costs.json); price_fit: from measured seconds
    error_calibration  what knobs leave (plan/cost/errors.json), by knob_errors on the stages of error_cases
    report          rows, the front, and files
    chart, page     error against seconds as SVG, the report as HTML
    fit_candidates  a stencil model and its rivals, fitted to one measurement
    fit_metrics     how far each is off, by scikit-image where it is installed
    fit_pictures    BRDFs unfolded into pictures, slices as charts
    fit_report      all of it as a folder with an HTML page
"""

from ..lazy import lazily

_NAMES = {"Report": "report", "Row": "report", "sweep": "sweeping"}
__all__ = ["Report", "Row", "sweep"]
__getattr__, __dir__ = lazily(__name__, _NAMES)
