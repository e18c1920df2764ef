"""Builds the extension module with CMake, from the sources around this folder.

Environment: CMAKE_ARGS, further arguments to configure with; KDS_BUILD_FOLDER, a build of kds to use as it is
configured (with KDS_BUILD_PYTHON), in place of build/pip.
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent.parent


def version() -> str:
    text = (ROOT / "kds" / "version.hpp").read_text()
    return ".".join(re.findall(r"^#define KDS_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)$", text, re.M))


class BuildWithCMake(build_ext):
    def build_extension(self, extension: Extension) -> None:
        given = os.environ.get("KDS_BUILD_FOLDER")
        build = pathlib.Path(given) if given else ROOT / "build" / "pip"
        if not given:
            options = ["-DCMAKE_BUILD_TYPE=Release", "-DKDS_BUILD_PYTHON=ON", f"-DKDS_PYTHON={sys.executable}"]
            more = shlex.split(os.environ.get("CMAKE_ARGS", ""))
            subprocess.run(["cmake", "-S", ROOT, "-B", build, *options, *more], check=True)
        jobs = str(self.parallel or os.cpu_count() or 1)
        subprocess.run(["cmake", "--build", build, "--target", "kds_python", "--parallel", jobs], check=True)
        made = build / "python" / "kds" / ("_kds" + sysconfig.get_config_var("EXT_SUFFIX"))
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(made, target)


# What setuptools makes on the way goes to the build folder too.
made = ROOT / "build" / "setuptools"
made.mkdir(parents=True, exist_ok=True)
setup(
    version=version(),
    ext_modules=[Extension("kds._kds", [])],
    cmdclass={"build_ext": BuildWithCMake},
    options={"build": {"build_base": str(made)}, "egg_info": {"egg_base": str(made)}},
)
