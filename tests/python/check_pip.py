"""pip installs the module from the source tree, with the extension that the build has made; and it runs from there."""

import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
TWO_BALLS = """
import kds
world = kds.World()
world.add_bodies(kds.sphere(1), [[0, 0, 0], [4, 0, 0]], [[1, 0, 0], [0, 0, 0]])
print(kds.__file__, world.advance_to(3).time)
"""

with tempfile.TemporaryDirectory() as folder:
    options = ["--no-build-isolation", "--no-deps", "--no-index", "--quiet", "--target", folder]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run([sys.executable, "-m", "pip", "install", ROOT / "python", *options], check=True, env=environment)
    ran = subprocess.run(
        [sys.executable, "-c", TWO_BALLS],
        check=True,
        cwd=folder,
        env={**environment, "PYTHONPATH": folder},
        stdout=subprocess.PIPE,
        text=True,
    )
    there = os.path.join(folder, "kds", "__init__.py")
    if ran.stdout != f"{there} [2.]\n":
        sys.exit(f"expected the module in {there}, and a contact at 2: {ran.stdout}")
