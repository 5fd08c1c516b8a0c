#!/usr/bin/env bash
# contained_tcsim.sh ARGUMENTS...: tcsim of $TCS_BUILD as somebody without any rights, but for the files that are its
# own, where the calls are refused that Docker refuses to all containers.
as=(prlimit --rtprio=0:0 --nice=0:0)
((EUID != 0)) || as+=(setpriv --bounding-set=-all --inh-caps=-all)
exec "${as[@]}" "$TCS_BUILD/bin/in_container_profile" "$TCS_BUILD/bin/tcsim" "$@"
