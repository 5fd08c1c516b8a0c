#!/usr/bin/env bash
# natively.sh BUILD COMMAND...: the kernel is the reference for what COMMAND expects.
set -u
source "$(dirname -- "${BASH_SOURCE[0]}")/../steadily.sh"
steadily "$1" timeout 19 "${@:2}"
