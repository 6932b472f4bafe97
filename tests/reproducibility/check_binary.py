#!/usr/bin/env python3
"""Disassembles compiled code and finds what would make results depend on compiler or machine.

    check_binary.py FILE ...       archives, objects or programs of any architecture whose objdump is there
    check_binary.py --self-test    compiles code with such faults, and demands that they are found

Two things are forbidden: a fused multiply-add, which rounds once where a product and a sum round twice; and a function of
libm that may differ between C libraries. Allowed are sqrt, which IEEE 754 wants correctly rounded, and functions whose
result is exact. Exit code 0: clean; 1: found something; 2: cannot look.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# Mnemonics that multiply and add with one rounding, by what objdump calls the file format.
FUSED = {
    "x86-64": r"vfn?m(add|sub|addsub|subadd)\w*",
    "aarch64": r"fn?m(add|sub)|fml[as]l?2?|fcmla|bfml\w*|fmmla",
    "s390": r"m[as][deyx][yhl]?[bl]?r?|wfn?m[as][dsx]?b?|vfn?m[as]([dsx]b)?",
    "powerpc": r"fn?m(add|sub)s?\.?|xs?vn?m(add|sub)[am][ds]p|xsn?m(add|sub)[am][dsq]p\w*",
    "riscv": r"fn?m(add|sub)\.[dsq]|vfn?m(acc|sac|add|sub)\.v[vf]",
}
ALLOWED = {"sqrt", "ceil", "floor", "trunc", "fabs", "copysign", "frexp", "ldexp", "scalbn", "modf", "nextafter"}
# What libm offers for double; the suffixes are for float and long double, __*_finite is what -ffast-math calls.
LIBM = """acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp10 exp2 expm1 fabs fdim floor
fma fmod frexp gamma hypot j0 j1 jn ldexp lgamma lgamma_r log log10 log1p log2 logb modf nextafter pow pow10 powi remainder
remquo rint scalb scalbn sin sincos sinh sqrt tan tanh tgamma trunc y0 y1 yn""".split()
LIBM_NAME = re.compile(rf"(?:__)?({'|'.join(LIBM)})[fl]?(?:_finite)?$|_ZGV\w+_({'|'.join(LIBM)})[fl]?$")
THREADS = re.compile(r"pthread_create|GOMP_parallel|__kmpc_fork_call|_ZNSt6thread\w*")
EXAMPLES = {
    "fused": "double f(double a, double b, double c) { return a * b + c; }",
    "fused in a loop": "void f(double* a, const double* b, double c) { for (int i = 0; i < 64; ++i) a[i] -= b[i] * c; }",
    "libm": "#include <cmath>\ndouble f(double a) { return std::exp(a); }",
    "libm of float": "#include <cmath>\nfloat f(float a) { return std::sin(a); }",
    "thread": "#include <thread>\nvoid f() { std::thread([] {}).join(); }",
}
CLEAN = "#include <cmath>\ndouble f(double a, double b) { return std::sqrt(a * b + 1.0) + std::ceil(b); }"


def output_of(*command):
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        print(f"check_binary: {command[0]}: {done.stderr.strip()}", file=sys.stderr)
        sys.exit(2)
    return done.stdout


def prefix_for(file):
    """"" or "aarch64-linux-gnu-": the binutils that know the file."""
    prefixes = ["", "aarch64-linux-gnu-", "s390x-linux-gnu-", "powerpc64-linux-gnu-", "riscv64-linux-gnu-"]
    for prefix in prefixes:
        if shutil.which(prefix + "objdump"):
            done = subprocess.run([prefix + "objdump", "-f", file], capture_output=True, text=True, check=False)
            if done.returncode == 0 and "UNKNOWN" not in done.stdout:
                return prefix
    print(f"check_binary: no objdump here knows {file}", file=sys.stderr)
    sys.exit(2)


def fused_instructions(file, prefix):
    where, architecture, found, instructions = "", "", [], 0
    for line in output_of(prefix + "objdump", "-d", "-C", "--no-show-raw-insn", file).splitlines():
        if "file format" in line:
            architecture = next((name for name in FUSED if name in line), "")
            if not architecture:
                print(f"check_binary: no list of instructions for{line.split('file format')[1]}", file=sys.stderr)
                sys.exit(2)
            fused = re.compile(FUSED[architecture])
        elif line.endswith(">:"):
            where = line.split(" ", 1)[1][1:-2]
        else:
            words = line.split()
            if len(words) > 1 and words[0].endswith(":"):
                instructions += 1
                if fused.fullmatch(words[1]):
                    found.append(f"{' '.join(words[1:])} in {where}")
    if instructions == 0:
        print(f"check_binary: {file} holds no code", file=sys.stderr)
        sys.exit(2)
    return found


def forbidden_symbols(file, prefix):
    names = {words[-1].split("@")[0] for words in map(str.split, output_of(prefix + "nm", "-u", file).splitlines()) if words}
    found = []
    for name in sorted(names):
        match = LIBM_NAME.match(name)
        if match and (match[1] or match[2]) not in ALLOWED:
            found.append(f"call of {name}, whose last bits differ between C libraries")
        if THREADS.match(name):
            found.append(f"call of {name}: an order of sums that depends on threads")
    return found


def complaints_about(file):
    prefix = prefix_for(file)
    found = fused_instructions(file, prefix) + forbidden_symbols(file, prefix)
    return [f"{file}: {complaint}" for complaint in found]


def self_test():
    """Every compiler at hand makes the faulty examples; each must be found, and the clean one must not."""
    compilers = [("g++", "-mfma"), ("clang++", "-mfma"), ("aarch64-linux-gnu-g++", ""), ("s390x-linux-gnu-g++", "")]
    missed = 0
    with tempfile.TemporaryDirectory() as scratch:
        source, binary = pathlib.Path(scratch) / "example.cpp", str(pathlib.Path(scratch) / "example.o")
        for compiler, flag in compilers:
            if shutil.which(compiler) is None:
                print(f"{compiler}: not here")
                continue
            common = [compiler, "-std=c++20", "-O3", *flag.split(), "-c", str(source), "-o", binary]
            for name, text in EXAMPLES.items():
                source.write_text(text + "\n", encoding="utf-8")
                output_of(*common, "-ffp-contract=fast")
                found = complaints_about(binary)
                print(f"{compiler}, {name}: " + (found[0].split(": ", 1)[1] if found else "MISSED"))
                missed += not found
            source.write_text(CLEAN + "\n", encoding="utf-8")
            output_of(*common, "-ffp-contract=off")
            if complaints_about(binary):
                print(f"{compiler}, clean: WRONGLY FOUND {complaints_about(binary)}")
                missed += 1
    return 1 if missed else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*")
    parser.add_argument("--self-test", action="store_true")
    given = parser.parse_args()
    if given.self_test:
        return self_test()
    if not given.files:
        parser.error("name a FILE, or --self-test")
    found = [complaint for file in given.files for complaint in complaints_about(file)]
    print("\n".join(found) if found else "no fused multiply-add, no libm but exact functions, no threads: " + ", ".join(given.files))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
