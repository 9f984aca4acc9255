"""Recipe of the cloth module for Conan 2: voile::gpu and voile::cloth, without the engine."""
import re
from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy

required_conan_version = ">=2.0"


class VoileConan(ConanFile):
    name = "voile"
    description = "Cloth simulated on the GPU, in the frame's own command buffer"
    license = "MIT"
    topics = ("vulkan", "cloth", "simulation", "physics")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    exports_sources = "CMakeLists.txt", "LICENSE", "cmake/*", "modules/*", "shaders/*"
    implements = ["auto_shared_fpic"]

    def set_version(self):
        header = Path(self.recipe_folder, "modules/gpu/include/voile/version.hpp").read_text()
        parts = re.findall(r"#define VOILE_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)
        self.version = ".".join(parts)

    def requirements(self):
        self.requires("glm/[>=0.9.9.8]", transitive_headers=True)
        self.requires("vulkan-headers/[>=1.3.204]", transitive_headers=True)
        self.requires("vulkan-memory-allocator/[>=3.0]", visible=False)

    def build_requirements(self):
        self.tool_requires("cmake/[>=3.25]")
        self.tool_requires("glslang/[>=1.3.204]")
        self.tool_requires("spirv-tools/[>=1.3.204]", options={"build_executables": True})

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("ENGINE", "TESTS", "BENCH"):
            toolchain.cache_variables[f"VOILE_BUILD_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        copy(self, "LICENSE", self.source_folder, str(Path(self.package_folder, "licenses")))
        CMake(self).install()

    def package_info(self):
        self.cpp_info.set_property("cmake_file_name", "voile")
        gpu = self.cpp_info.components["gpu"]
        gpu.set_property("cmake_target_name", "voile::gpu")
        gpu.libs = ["voile_gpu"]
        gpu.requires = ["vulkan-headers::vulkan-headers", "vulkan-memory-allocator::vulkan-memory-allocator"]
        gpu.defines = ["VOILE_SHARED"] if self.options.shared else []
        cloth = self.cpp_info.components["cloth"]
        cloth.set_property("cmake_target_name", "voile::cloth")
        cloth.libs = ["voile_cloth"]
        cloth.requires = ["gpu", "glm::glm"]
        if self.settings.os in ("Linux", "FreeBSD"):
            cloth.system_libs = ["pthread"]
