"""A controller of one's own: a paddle is pushed to and fro so that the water at a gauge stands high
when it should. A hand could do it in the window; here it looks at the gauge every 0.02 s.

    PYTHONPATH=build/python python3 examples/paddle.py
"""
import math

import spindrift

run = spindrift.Run({
    "version": 2,
    "simulation": {"spacing": 0.03},
    "domain": {"max": [2, 0.8, 0.3]},
    "solids": [{"name": "paddle", "shape": "block", "min": [0.1, 0.05, 0], "max": [0.2, 0.7, 0.3]}],
    "fluid": {"bodies": [{"shape": "block", "min": [0, 0, 0], "max": [2, 0.3, 0.3]}]},
    "output": {"probes": [{"kind": "height", "name": "gauge", "position": [1.5, 0, 0.15]}]},
})
home = run.solids()["paddle"]["position"]
place = home[0]


def control(run):
    global place
    wanted = 0.3 + 0.03 * math.sin(2 * math.pi * run.time)
    high = run.probes()["gauge.height"]
    place = min(max(place + 0.4 * (wanted - high), home[0] - 0.05), home[0] + 0.3)
    run.hold("paddle", [place, home[1], home[2]])
    push = run.solids()["paddle"]["force"][0]
    print(f"{run.time:5.2f} s  wanted {wanted:.3f} m  stands {high:.3f} m  "
          f"paddle at {place:.3f} m, fluid pushes it with {push:7.1f} N")


run.run(2, each=control, every=0.02)
