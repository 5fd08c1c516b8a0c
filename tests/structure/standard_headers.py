#!/usr/bin/env python3
"""Each source that names an algorithm of the standard library includes <algorithm>. On Debian 12 other headers of GCC bring it
along, on Debian 13 they do not, so that only a build there would tell."""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
TOPS = ("shm", "libtcs_preload", "coordinator", "simbody_bridge", "examples", "tests")
ALGORITHM = re.compile(
    r"std::(?:ranges::(?!views\b|begin\b|end\b|size\b|empty\b|data\b)\w+|(?:max|min|clamp|minmax|min_element|max_element|sort|"
    r"stable_sort|find|find_if|count|count_if|copy|copy_n|fill|fill_n|any_of|all_of|none_of|equal|transform|reverse|unique|"
    r"remove_if|lower_bound|upper_bound|binary_search|nth_element|rotate|for_each|generate|mismatch|is_sorted))\(")


def main() -> int:
    wrong, seen = [], 0
    for top in TOPS:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cc"):
                continue
            text = path.read_text()
            named = ALGORITHM.search(text)
            seen += named is not None
            if named is not None and "#include <algorithm>" not in text:
                line = text.count("\n", 0, named.start()) + 1
                wrong.append(f"{path.relative_to(ROOT)}:{line}: {named[0][:-1]} needs #include <algorithm>: on Debian 13 no other header brings it along")
    print("\n".join(wrong))
    assert seen > 100, f"only {seen} sources name an algorithm"
    return 1 if wrong else 0


sys.exit(main())
