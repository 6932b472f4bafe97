"""The cells of the reproducibility matrix: compilers, flags, architectures, C libraries."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Cell:
    """One way to build the library, and one way to run it. Cells of the same `build` share a build folder."""
    build: str
    compiler: str = "g++"
    flags: str = "-O2"
    lto: bool = False
    last_flags: str = ""  # behind those of the library, which forbid contraction
    toolchain: str = ""  # a CMake toolchain file in cell/
    emulator: tuple = ()  # what runs the program
    environment: tuple = ()  # (name, value)
    cpu_flag: str = ""  # of /proc/cpuinfo, without which the program cannot run
    leave_out: str = ""  # effects not compiled in
    refused_with: str = ""  # the program must end with this message instead of results
    seconds: int = 30  # of processor time, build and run; ctest begins with the longest


NO_FMA = ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA,-FMA4")

# No golden folder calls for these: their absence must not change a bit.
UNUSED_EFFECTS = "traction;mass_damping;viscosity;bulk_viscosity;manufactured;plasticity;piston;wall;absorbing;contact;interface"

CELLS = {
    "g++ -O0": Cell("gcc-O0", flags="-O0", seconds=70),
    "g++ -O2": Cell("gcc-O2"),
    "g++ -O2 without the effects that are not called for": Cell("gcc-O2-few-effects", leave_out=UNUSED_EFFECTS),
    "g++ -O3 -march=native": Cell("gcc-O3-native", flags="-O3 -march=native"),
    "g++ -O2 with LTO": Cell("gcc-O2-lto", lto=True, seconds=40),
    "clang++ -O0": Cell("clang-O0", "clang++", "-O0", seconds=70),
    "clang++ -O2": Cell("clang-O2", "clang++"),
    "clang++ -O3 -march=native": Cell("clang-O3-native", "clang++", "-O3 -march=native"),
    "clang++ -O2 with LTO": Cell("clang-O2-lto", "clang++", lto=True, seconds=40),
    "x86-64-v1": Cell("x86-64-v1", flags="-O3 -march=x86-64", emulator=("qemu-x86_64", "-cpu", "qemu64"), seconds=130),
    "aarch64": Cell("aarch64", "aarch64-linux-gnu-g++", toolchain="aarch64.cmake", emulator=("qemu-aarch64",),
                    seconds=120),
    "s390x, big-endian": Cell("s390x", "s390x-linux-gnu-g++", toolchain="s390x.cmake", emulator=("qemu-s390x",),
                              seconds=320),
    "valgrind": Cell("gcc-O2", emulator=("valgrind", "--tool=none", "-q"), seconds=110),
    "glibc without FMA": Cell("gcc-O2", environment=(NO_FMA,)),
    "refused: fast-math": Cell("gcc-fast-math", flags="-O1", last_flags="-ffast-math", refused_with="build without -ffast-math"),
    "refused: contraction": Cell("gcc-contracted", last_flags="-mfma;-ffp-contract=fast", cpu_flag="fma",
                                 refused_with="build with -ffp-contract=off"),
}
