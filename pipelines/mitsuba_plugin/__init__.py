"""Scratched materials in Mitsuba 3: a BSDF that reflects by simulated tables.

This folder needs NumPy, Mitsuba and Dr.Jit alone, and is copied beside every exported scene. After a variant of LLVM or
CUDA is set (``mitsuba.set_variant("llvm_ad_rgb")``), ``bsdf.register(folder)`` makes the plugin known. It has one
parameter, the string ``data``: an archive that ``scratchwarp export`` wrote.

The model: Lambert under GGX under a coat where there are no scratches; on a scratch that runs along u the light from
the cone theta_i = -theta_o alone, L_r = integral of rho(phi_o, phi_i; theta) cos(phi_i) L_i dphi_i with the table rho.
That is a delta in one of two angles, so Mitsuba finds it by sampling the BSDF only. Under small lights export with a
blur: a normal distribution of theta_i of that deviation [rad], which lights can be sampled for.
"""
