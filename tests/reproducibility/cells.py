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
    whole: bool = False  # runs small scenes with the whole library, instead of all golden folders
    refused_with: str = ""  # the program must end with this message instead of results
    seconds: int = 30  # of processor time, build and run; ctest begins with the longest


NO_FMA = ("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX512F,-AVX2,-FMA,-FMA4")

# No golden folder calls for these: their absence must not change a bit.
UNUSED_EFFECTS = "traction;mass_damping;viscosity;bulk_viscosity;manufactured;piston;wall;absorbing;contact;interface"

# What the small scenes give here, for the cells that run them: g++ -O2, which is held against the golden data, with the whole library.
NATIVE = Cell("gcc-O2-whole", whole=True)

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
    "x86-64-v1": Cell("x86-64-v1", flags="-O3 -march=x86-64", emulator=("qemu-x86_64", "-cpu", "qemu64"), whole=True, seconds=130),
    "aarch64": Cell("aarch64", "aarch64-linux-gnu-g++", toolchain="aarch64.cmake", emulator=("qemu-aarch64",), whole=True,
                    seconds=120),
    "s390x, big-endian": Cell("s390x", "s390x-linux-gnu-g++", toolchain="s390x.cmake", emulator=("qemu-s390x",), whole=True,
                              seconds=140),
    "valgrind": Cell("gcc-O2-whole", emulator=("valgrind", "--tool=none", "-q"), whole=True, seconds=60),
    "glibc without FMA": Cell("gcc-O2", environment=(NO_FMA,)),
    "refused: fast-math": Cell("gcc-fast-math", flags="-O1", last_flags="-ffast-math", refused_with="build without -ffast-math"),
    "refused: contraction": Cell("gcc-contracted", last_flags="-mfma;-ffp-contract=fast", cpu_flag="fma",
                                 refused_with="build with -ffp-contract=off"),
}


# What the check of the arithmetic refuses: what is done, a part of the message, builds that do it (with -ffp-contract=off before).
REFUSED_BUILDS = [
    ("all that `-ffast-math` stands for", "build without -ffast-math",
     ["g++ -O2 -ffast-math", "g++ -Ofast", "clang++ -O2 -ffast-math", "clang++ -Ofast", "clang++ -O2 -ffp-model=fast"]),
    ("a product and a sum become one rounding", "-ffp-contract=off",
     ["g++ -O2 -mfma -ffp-contract=fast", "clang++ -O1 -mfma -ffp-contract=fast", "clang++ -O2 -mfma -ffp-contract=on"]),
    ("x/h becomes x·(1/h)", "-freciprocal-math", ["g++ -O2 -freciprocal-math", "clang++ -O2 -freciprocal-math", "clang++ -O0 -freciprocal-math"]),
    ("sums in another order", "-fassociative-math",
     ["g++ -O2 -funsafe-math-optimizations", "g++ -O2 -fassociative-math -fno-signed-zeros -fno-trapping-math",
      "clang++ -O2 -funsafe-math-optimizations", "clang++ -O2 -fassociative-math -fno-signed-zeros -fno-trapping-math"]),
    ("every number is taken for finite", "-ffinite-math-only",
     ["g++ -O2 -ffinite-math-only", "clang++ -O2 -ffinite-math-only", "clang++ -O2 -fno-honor-nans"]),
    ("−0 is taken for 0", "-fno-signed-zeros", ["g++ -O2 -fno-signed-zeros", "clang++ -O2 -fno-signed-zeros", "clang++ -O0 -fno-signed-zeros"]),
    ("more than double precision: `FLT_EVAL_METHOD` is not 0", "FLT_EVAL_METHOD",
     ["g++ -O2 -mfpmath=both", "g++ -O2 -mfpmath=387", "g++ -O0 -mfpmath=387 -ffloat-store"]),
    ("constants are read as float", "-fsingle-precision-constant", ["g++ -O2 -fsingle-precision-constant", "g++ -O0 -fsingle-precision-constant"]),
]
