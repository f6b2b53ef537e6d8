"""A cross-section and what it does to light: shapes, a 2D ray tracer in Warp, tables over (phi_o, phi_i).

Files, the way a table is made: ``profile`` the record, ``shapes`` named ones, ``outline`` scaled for the kernels;
``tracer_device`` the next hit, ``path_device`` a whole path, ``trace_kernels`` all rays of a column; ``reflectors``
Fresnel as rows, ``energy_kernels`` and ``polarised_kernels`` what paths carry and where it lands; ``paths`` the host
of both passes, ``launch`` threads; ``tracing`` columns and symmetries, ``balance`` (and its kernels) whole tables,
``simulation`` the calls, ``mixture`` averages of tables; ``theta`` models along the scratch, ``theta_choice`` their
errors; ``table`` the result, ``table_device`` and ``table_kernels`` its sampling; ``facet_table`` one of facets and
masking alone; ``drawing`` a picture of it; ``single_rays`` rays to look at; ``simplify`` fewer facets; ``cache`` tables
on disk.
"""

from scratchwarp.profiles.cache import Store as Store
from scratchwarp.profiles.cache import read_table as read_table
from scratchwarp.profiles.cache import store as store
from scratchwarp.profiles.cache import write_table as write_table
from scratchwarp.profiles.drawing import picture as picture
from scratchwarp.profiles.facet_table import facet_table as facet_table
from scratchwarp.profiles.mixture import between as between
from scratchwarp.profiles.mixture import mixture as mixture
from scratchwarp.profiles.profile import Profile as Profile
from scratchwarp.profiles.shapes import shape as shape
from scratchwarp.profiles.shapes import shape_names as shape_names
from scratchwarp.profiles.simplify import simplified as simplified
from scratchwarp.profiles.simulation import simulate as simulate
from scratchwarp.profiles.simulation import simulate_full as simulate_full
from scratchwarp.profiles.single_rays import Rays as Rays
from scratchwarp.profiles.single_rays import trace as trace
from scratchwarp.profiles.table import Table as Table
from scratchwarp.profiles.theta import THETA_MODELS as THETA_MODELS
from scratchwarp.profiles.theta_choice import choose_theta_model as choose_theta_model
from scratchwarp.profiles.theta_choice import theta_model_errors as theta_model_errors
from scratchwarp.profiles.tracing import SAMPLERS as SAMPLERS
from scratchwarp.profiles.tracing import Request as Request
from scratchwarp.profiles.tracing import Traced as Traced
from scratchwarp.profiles.tracing import trace_paths as trace_paths
