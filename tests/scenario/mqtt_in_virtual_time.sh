#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Debian's MQTT broker and its clients, unmodified: a message is seen when it is sent, the first one
# 1 s after the subscription, the others 5 s apart, by one publisher or by one for each.
# Topics: ordinary programs, tcp, timers, containers.
PATH=$PATH:/usr/sbin
command -v mosquitto mosquitto_sub mosquitto_pub > /dev/null || exit 77
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
port=$((20000 + $$ % 10000))
cat > "$scratch/broker.conf" << END
listener $port 127.0.0.1
allow_anonymous true
persistence false
user $(id -un)
END
cat > "$scratch/robot.sh" << 'END'
port=$1 scratch=$2
mosquitto -c "$scratch/broker.conf" 2> "$scratch/broker.log" &
broker=$!
sleep 2
mosquitto_sub -p "$port" -t ticks -C 7 -F '%U %p' > "$scratch/seen" &
reader=$!
sleep 1
for pause in 0 5 5; do
  sleep $pause
  mosquitto_pub -p "$port" -t ticks -m "$(date +%s.%N)"
done
for pause in 5 5 5 5; do
  sleep $pause
  date +%s.%N
done | mosquitto_pub -p "$port" -t ticks -l
wait $reader
kill $broker
wait $broker
END
for accounting in measured fixed; do
  rm -f "$scratch/seen"
  "$tcsim" exec --accounting "$accounting" --date 2005-03-18 -- \
    bash "$scratch/robot.sh" "$port" "$scratch" || fail "$accounting: it ended with $?"
  # Starting programs takes some virtual time, waiting for what is there none.
  awk -v accounting="$accounting" '
    { late = $1 - $2
      if (late < 0 || late > 0.15) { printf "message %d was seen %g s after it was sent\n", NR, late; bad = 1 }
      if (NR > 1 && ($1 - last < 4.85 || $1 - last > 5.3)) {
        printf "message %d was seen %g s after the one before\n", NR, $1 - last; bad = 1 }
      last = $1 }
    END { if (NR != 7) { printf "%d messages of 7 were seen\n", NR; bad = 1 }
          exit bad }' "$scratch/seen" || fail "$accounting: $(cat "$scratch/seen")"
done
