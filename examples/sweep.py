"""A parameter sweep: how far the front of a dam break comes in 0.4 s in thicker and thicker fluid.

    PYTHONPATH=build/python python3 examples/sweep.py [plot.png]     (the plot needs matplotlib)
"""
import sys

import spindrift

VISCOSITIES = [0.001, 1, 10, 100, 1000]  # Pa s


def front_after(viscosity):
    run = spindrift.Run("dam_break", {"simulation.spacing": 0.03, "fluid.viscosity": viscosity})
    run.run(0.4)
    return run.particles().position[:, 0].max()


fronts = [front_after(viscosity) for viscosity in VISCOSITIES]
for viscosity, front in zip(VISCOSITIES, fronts):
    print(f"{viscosity:8g} Pa s  {front:.3f} m")
if len(sys.argv) > 1:
    import matplotlib.pyplot as plot

    plot.semilogx(VISCOSITIES, fronts, "o-")
    plot.xlabel("viscosity, Pa s")
    plot.ylabel("front after 0.4 s, m")
    plot.savefig(sys.argv[1])
