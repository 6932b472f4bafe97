#!/usr/bin/env python3
"""What is absent costs nothing: the plan of a plain scene against the same kernels called by hand.

    tests/cost/check_plan.py build/release/tests/hand_step
"""
import subprocess
import sys
import tempfile

from check_cost import instructions

# Of the instructions of a step. The plan calls some ten stages and steps through as many lists of phases.
MOST = 0.01


def main():
    tool = sys.argv[1]
    subprocess.run([tool, "check", "64", "2000"], check=True)
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for cells in (64, 512):
            plan, hand = (4 * cells * instructions(lambda steps: [tool, mode, str(cells), str(steps)], cells, folder) for mode in ("plan", "hand"))
            more = (plan - hand) / hand
            failed |= more > MOST
            print(f"{4 * cells} particles: {plan:.0f} instructions a step by the plan, {hand:.0f} by hand, {100 * more:+.2f} %; at most {100 * MOST:.0f} %")
            if cells == 64:
                few = plan - hand
        # What the plan adds is per step, not per particle: the same for four times the particles, but for a tenth of an instruction each.
        failed |= plan - hand - few > 0.1 * 4 * (512 - 64)
        print(f"the plan adds {few:.0f} instructions to a step of 256 particles, {plan - hand:.0f} to one of 2048")
    sys.exit("the plan costs more than it may" if failed else 0)


if __name__ == "__main__":
    main()
