#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""Extensions of compilers, processors and systems are in two files only, where each has a portable branch. No result
depends on the mathematics library."""

import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MAY_USE_EXTENSIONS = {"vcg_core/base/simd.h", "vcg_core/base/platform.h"}
EXTENSIONS = {
    "a builtin of GCC": r"\b__builtin_",
    "an attribute of GCC": r"__attribute__|\[\[\s*(gnu|clang)::",
    "a macro of a compiler, processor or system": r"\b(__GNUC__|__clang__|_MSC_VER|__SSE\w*|__AVX\w*|__x86_64__"
                                                  r"|__aarch64__|__linux__|__ELF__|_WIN32|__APPLE__)\b",
    "an intrinsic of x86": r"\b_mm\d*_|\b__m(128|256|512)|<\w*mmintrin\.h>|<immintrin\.h>",
    "a header of POSIX": r"<(unistd|dlfcn|fcntl|pthread|sched|signal|poll|strings|dirent)\.h>|<sys/",
    "a call of POSIX": r"\b(madvise|mmap|dlsym|dlopen|sysconf|posix_memalign|pthread_\w+)\s*\(",
    "a type whose size depends on the system": r"\b(?<!long )long\b(?! (long|double)\b)|\bssize_t\b|\b__int128\b",
    "a macro that Windows does not define by default": r"\bM_(PI|E|SQRT2|LN2)\w*\b",
    "a function whose last bit depends on the mathematics library":
        r"\bstd::(sin|cos|tan|asin|acos|atan2?|sinh|cosh|tanh|exp2?|expm1|log|log2|log10|log1p|pow|cbrt|hypot)f?\(",
    "aligned_alloc, which Windows lacks": r"\baligned_alloc\b",
}
COMMENT_OR_STRING = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:[^"\\\n]|\\.)*"', re.DOTALL)


def code_of(text):
    """The text without comments and strings, in the same lines. Names of included files stay: they are in <>."""
    return COMMENT_OR_STRING.sub(lambda found: "\n" * found[0].count("\n"), text)


def extensions_used(root):
    """One sentence for each line that uses an extension outside the two files."""
    for file in sorted(path for folder in ("vcg_core", "filter_neuralmesh") for path in (root / folder).rglob("*.[hc]*")):
        path = str(file.relative_to(root))
        if path in MAY_USE_EXTENSIONS:
            continue
        for number, line in enumerate(code_of(file.read_text()).splitlines(), 1):
            for what, pattern in EXTENSIONS.items():
                if re.search(pattern, line):
                    yield f"{path}:{number}: {what}; it belongs to base/simd.h or base/platform.h."


class Portability(unittest.TestCase):
    def test_extensions_are_in_two_files(self):
        found = list(extensions_used(ROOT))
        self.assertFalse(found, "\n" + "\n".join(found))


if __name__ == "__main__":
    sys.exit(unittest.main())
