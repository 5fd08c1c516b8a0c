#!/usr/bin/env bash
# Whether robots can have networks of their own here.
unshare --net --uts --mount true 2> /dev/null && [[ -c /dev/net/tun ]] && : 2> /dev/null <> /dev/net/tun
