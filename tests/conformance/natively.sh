#!/usr/bin/env bash
# natively.sh BUILD PROGRAM: the kernel is the reference for what PROGRAM expects. On an idle machine it takes up to 8 s.
# Some programs compute for several seconds, and beside others they have a fifth of a processor.
set -u
source "$(dirname -- "${BASH_SOURCE[0]}")/../steadily.sh"
steadily "$1" timeout 100 "$2"
