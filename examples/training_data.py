"""Training data for a network that learns how fluid moves: places and velocities of the particles
of some random drops, picture by picture, as one compressed file of NumPy's.

    PYTHONPATH=build/python python3 examples/training_data.py drops.npz
"""
import sys

import numpy as np

import spindrift

FRAME = 1 / 60  # s


def drop(seed):
    random = np.random.default_rng(seed)
    radius = float(random.uniform(0.1, 0.18))
    return {
        "version": 2,
        "simulation": {"formulation": "incompressible", "spacing": 0.03},
        "domain": {"max": [1, 1, 1]},
        "fluid": {"bodies": [{
            "shape": "sphere", "radius": radius,
            "center": [float(random.uniform(0.3, 0.7)) for _ in range(3)],
            "velocity": [float(random.uniform(-1, 1)) for _ in range(3)],
        }]},
    }


arrays = {}
for seed in range(3):
    run = spindrift.Run(drop(seed))
    frames = []

    def keep(run, frames=frames):
        particles = run.particles()
        frames.append(np.concatenate([particles.position, particles.velocity], axis=1))

    keep(run)
    run.run(0.5, each=keep, every=FRAME)
    arrays[f"drop{seed}"] = np.float32(frames)  # frames x particles x 6
    print(f"drop {seed}: {arrays[f'drop{seed}'].shape}, density error "
          f"{100 * run.measure()['density_error']:.2g} %")
np.savez_compressed(sys.argv[1] if len(sys.argv) > 1 else "drops.npz", **arrays)
