#!/bin/sh
# install.sh [FOLDER]: puts tcs into FOLDER, by default /opt/tcs for root and ~/.local/tcs for others. It may as well be
# used from here, as bin/tcsim. To remove it, delete FOLDER.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
[ "$(id -u)" = 0 ] && default=/opt/tcs || default=$HOME/.local/tcs
folder=${1:-$default}
[ ! -e "$folder" ] || { echo "install.sh: $folder is there already; delete it, or name another folder" >&2; exit 1; }
mkdir -p "$folder"
cp -R "$here/bin" "$here/lib" "$here/include" "$here/share" "$folder/"
"$folder/bin/tcsim" --version
echo "To have it as a command: export PATH=\"$folder/bin:\$PATH\""
