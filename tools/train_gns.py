"""Trains a small graph network simulator (GNS) for one epoch on a data set of `pbf_tools
to-lagrangebench`, with the trainer of LagrangeBench 0.2.0, and shows how its loss falls.

    python tools/train_gns.py ramps_data
    python tools/train_gns.py ramps_data --steps 500 --out small

Exit codes: 0 done, 2 bad command line, 4 package not installed, 5 no data set, 6 the mean loss of
the last tenth of the steps is not below that of the first.
tools/LEARNING.md has the packages that it needs.
"""

import argparse
import contextlib
import io
import json
import math
import re
import statistics
import sys
import time
from pathlib import Path

parser = argparse.ArgumentParser(description=__doc__,
                                 formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("data", help="folder of the data set")
parser.add_argument("--steps", type=int, help="gradient steps (default: one epoch)")
parser.add_argument("--out", default="gns", help="folder of checkpoints (default %(default)s)")
parser.add_argument("--blocks", type=int, default=3, help="of message passing (default %(default)s)")
parser.add_argument("--latent", type=int, default=32, help="size of a layer (default %(default)s)")
parser.add_argument("--rate", type=float, default=1e-3, help="learning rate (default %(default)s)")
PAST = 6  # positions that the network sees
ROLLOUT = 20  # frames that it must predict in the validation


class Losses(io.TextIOBase):
    """Takes what the trainer prints, and keeps the losses: `0123, train/loss: 0.45678.`"""

    def __init__(self, steps: int):
        self.values: list[float] = []
        self._every = max(1, steps // 20)
        self._start = time.monotonic()

    def write(self, text: str) -> int:
        found = re.findall(r"train/loss: (\S+)\.", text)
        self.values += map(float, found)
        if not found and text.strip():
            print(text.strip(), file=sys.stderr)
        elif found and len(self.values) % self._every == 0:
            print(f"{len(self.values)} steps, {time.monotonic() - self._start:.0f} s: mean loss "
                  f"{statistics.fmean(self.values[-self._every:]):.4f}", file=sys.stderr)
        return len(text)


def main() -> int:
    args = parser.parse_args()
    if args.steps is not None and args.steps < 20:
        parser.error("--steps must be at least 20")
    if not (Path(args.data) / "metadata.json").is_file():
        print(f"train_gns.py: error: {args.data}: no metadata.json in it; name the folder that "
              "pbf_tools to-lagrangebench wrote", file=sys.stderr)
        return 5
    try:
        import jax_sph.partition
        from lagrangebench.case_setup import case
        from lagrangebench.data import H5Dataset
        from lagrangebench.defaults import defaults
        from lagrangebench.runner import train_or_infer
        from omegaconf import OmegaConf
    except ImportError as missing:
        print(f"train_gns.py: error: {missing}; tools/LEARNING.md has the command that installs "
              "what is needed", file=sys.stderr)
        return 4

    # LagrangeBench 0.2.0 imports a search that does not know its setting neighbors.backend, and
    # makes all padding particles neighbors of each other; this is the one that it means.
    case.neighbor_list = jax_sph.partition.neighbor_list
    metadata = json.loads((Path(args.data) / "metadata.json").read_text())
    train = H5Dataset("train", args.data, name="ramps", input_seq_length=PAST)
    steps = len(train) if args.steps is None else args.steps
    # A tenth of the usual motion: the network learns to correct its own errors.
    noise = 0.1 * math.sqrt(statistics.fmean(v * v for v in metadata["vel_std"]))
    settings = {
        "mode": "train", "dtype": "float32", "dataset": {"src": args.data, "name": "ramps"},
        "model": {"name": "gns", "input_seq_length": PAST, "num_mp_steps": args.blocks,
                  "latent_dim": args.latent},
        "train": {"step_max": steps - 1, "num_workers": 0, "noise_std": noise,
                  "optimizer": {"lr_start": args.rate, "lr_decay_steps": steps},
                  "pushforward": {"steps": [-1], "unrolls": [0], "probs": [1]}},
        "eval": {"n_rollout_steps": ROLLOUT, "train": {"n_trajs": -1}},  # all for validation
        "logging": {"log_steps": 1, "eval_steps": max(1, (steps - 1) // 5), "ckp_dir": args.out,
                    "run_name": "gns"},
        # The number of particles differs from run to run: this search takes lists that are padded.
        "neighbors": {"backend": "matscipy"}}
    losses = Losses(steps)
    with contextlib.redirect_stdout(losses):
        train_or_infer(OmegaConf.merge(defaults, settings))
    tenth = max(1, len(losses.values) // 10)
    means = [statistics.fmean(losses.values[k:k + tenth]) for k in
             range(0, tenth * 10, tenth) if losses.values[k:k + tenth]]
    print(f"{len(losses.values)} steps, an epoch has {len(train)}; mean loss of each tenth: " +
          " ".join(f"{v:.4f}" for v in means))
    return 0 if means[-1] < means[0] else 6


if __name__ == "__main__":
    sys.exit(main())
