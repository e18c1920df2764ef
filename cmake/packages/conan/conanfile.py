"""Conan 2, of the sources that this recipe lies in: conan create cmake/packages/conan"""

import os
import re

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load

SOURCES = ("CMakeLists.txt", "LICENSE", "cmake/*", "kds/*", "certificates/*", "structures/*", "collision/*")


class Kds(ConanFile):
    name = "kds"
    description = "Kinetic data structures: exact event-driven geometry, and a collision engine made with it"
    license = "MIT"
    package_type = "static-library"
    settings = "os", "compiler", "build_type", "arch"
    options = {"splines": [True, False]}
    default_options = {"splines": False}

    def _root(self):
        return os.path.join(self.recipe_folder, "..", "..", "..")

    def set_version(self):
        numbers = re.findall(r"#define KDS_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)",
                             load(self, os.path.join(self._root(), "kds", "version.hpp")))
        self.version = ".".join(numbers)

    def export_sources(self):
        for pattern in SOURCES:
            copy(self, pattern, src=self._root(), dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def requirements(self):
        self.requires("boost/[>=1.74 <2]", transitive_headers=True)
        self.requires("eigen/[>=3.4 <4]", transitive_headers=True)

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables["KDS_BUILD_TOOL"] = False
        toolchain.cache_variables["KDS_WITH_GSL"] = False
        toolchain.cache_variables["KDS_BUILD_SPLINES"] = bool(self.options.splines)
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        # find_package(kds) finds what the library itself installs.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs.append(os.path.join("lib", "cmake", "kds"))
