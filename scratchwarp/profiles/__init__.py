"""A cross-section and what it does to light: shapes, a 2D ray tracer in Warp, tables over (phi_o, phi_i).

Files: ``profile`` the record, ``shapes`` named ones, ``outline`` made ready for kernels, ``tracer_device`` the next
hit, ``path_device`` a whole path, ``trace_kernels`` and ``energy_kernels`` the two passes, ``launch`` threads,
``paths`` their host, ``simulate`` symmetries and normalisation, ``theta`` models along the scratch, ``table`` the
result, ``table_device`` its sampling on the device.
"""

from scratchwarp.profiles.profile import Profile as Profile
from scratchwarp.profiles.shapes import shape as shape
from scratchwarp.profiles.shapes import shape_names as shape_names
from scratchwarp.profiles.simulate import SAMPLERS as SAMPLERS
from scratchwarp.profiles.simulate import simulate as simulate
from scratchwarp.profiles.simulate import simulate_full as simulate_full
from scratchwarp.profiles.table import Table as Table
