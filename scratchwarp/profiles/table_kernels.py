"""``Table.sample`` and ``Table.pdf`` over arrays: thin loops over ``table_device``."""

import warp as wp

from scratchwarp.profiles.table_device import table_pdf, table_sample

wp.set_module_options({"enable_backward": False})


@wp.kernel
def sample_table(
    cdf: wp.array(dtype=float, ndim=2),
    phi_o: wp.array(dtype=float),
    u: wp.array(dtype=float),
    phi_i: wp.array(dtype=float),
    pdf: wp.array(dtype=float),
):
    """``table_sample`` for each element."""
    k = wp.tid()
    angle, density = table_sample(cdf, phi_o[k], u[k])
    phi_i[k] = angle
    pdf[k] = density


@wp.kernel
def pdf_table(
    cdf: wp.array(dtype=float, ndim=2),
    phi_o: wp.array(dtype=float),
    phi_i: wp.array(dtype=float),
    pdf: wp.array(dtype=float),
):
    """``table_pdf`` for each element."""
    k = wp.tid()
    pdf[k] = table_pdf(cdf, phi_o[k], phi_i[k])
