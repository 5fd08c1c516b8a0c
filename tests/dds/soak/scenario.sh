# soak_scenario BUILD SAMPLES: the soak's four programs (main.cc) on three robots write so many samples; printed.
soak_scenario() {
  local build=$1 samples=$2
  program() { echo "{command: [\"$build/bin/dds_soak\", \"$1\", \"$samples\"]}"; }
  cat <<END
duration: 1h
robots:
  left: {cpu: {cores: 2}, clients: {zero: $(program 0), one: $(program 1)}}
  middle: {clients: {two: $(program 2)}}
  right: {clients: {three: $(program 3)}}
END
}
