# To be sourced: for tests that run tcsim as somebody without any rights, real-time priority among them.

# Goes before a command. Who has no rights to give up runs it as it is.
nobody=(prlimit --rtprio=0:0 --nice=0:0)
((EUID != 0)) || nobody+=(setpriv --reuid=65534 --regid=65534 --clear-groups --bounding-set=-all --inh-caps=-all)

# install_for_everybody BUILD FOLDER PROGRAM...: copies of tcsim, its libraries and these programs of BUILD, which
# need not be where everybody may read.
install_for_everybody() {
  local build=$1 folder=$2
  shift 2
  install -D -m 755 -t "$folder/bin" "$build/bin/tcsim" "$build/bin/tcsim-tools" "${@/#/$build/bin/}"
  install -D -m 755 -t "$folder/lib" "$build"/lib/libtcs_{preload,allocations,dds,physics}.so
}
