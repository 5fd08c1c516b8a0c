#!/usr/bin/env bash
source "$(dirname -- "${BASH_SOURCE[0]}")/common.sh"
# Go seeds the order of its maps and of what `select` finds ready by the cycle counter and by what the kernel draws for it: in
# fixed runs all of it repeats, tickers and sleeps with it. Go's programs are static, and may have no symbols.
# Topics: languages, determinism, preloading.
command -v go >/dev/null || exit 77
work=$(mktemp -d)
trap 'chmod -R u+w "$work"; rm -rf "$work"' EXIT
cat >"$work/order.go" <<'GO'
package main

import (
	"fmt"
	"math/rand"
	"os"
	"time"
)

func main() {
	begun := time.Now()
	order := map[int]int{}
	for i := 0; i < 20; i++ {
		order[i] = i
	}
	for key := range order {
		fmt.Print(key, " ")
	}
	ready := [3]chan int{make(chan int, 9), make(chan int, 9), make(chan int, 9)}
	for i := 0; i < 9; i++ {
		for j := range ready {
			ready[j] <- j
		}
	}
	fmt.Print("| ", rand.Intn(1000), " |")
	for i := 0; i < 9; i++ {
		select {
		case x := <-ready[0]:
			fmt.Print(x)
		case x := <-ready[1]:
			fmt.Print(x)
		case x := <-ready[2]:
			fmt.Print(x)
		}
	}
	ticker := time.NewTicker(10 * time.Millisecond)
	said := make(chan int)
	go func() {
		for i := 0; i < 10; i++ {
			time.Sleep(7 * time.Millisecond)
			said <- i
		}
	}()
	for ticks, heard := 0, 0; ticks < 10 || heard < 10; {
		select {
		case <-ticker.C:
			ticks++
		case x := <-said:
			heard++
			fmt.Print(" ", x, "@", ticks)
		}
	}
	took := time.Since(begun)
	fmt.Println(" |", took.Truncate(time.Microsecond))
	longest := 110 * time.Millisecond
	if len(os.Args) > 1 { // measured: what starting costs Go's threads is the host's
		longest = 200 * time.Millisecond
	}
	if took < 100*time.Millisecond || took > longest {
		panic("ten ticks of 10 ms")
	}
}
GO
export HOME=$work CGO_ENABLED=0 GOFLAGS=-mod=mod
(cd "$work" && go build -o plain order.go && go build -ldflags '-s -w' -o stripped order.go) || fail "go build"
runs=${3:-3}
for how in plain stripped; do
  for ((run = 1; run <= runs; ++run)); do
    timeout 200 "$tcsim" exec --accounting fixed -- sh -c "$work/$how" >"$work/$how.$run" 2>"$work/said" || fail "$how: $(cat "$work/said")"
    cmp "$work/$how.1" "$work/$how.$run" || fail "fixed runs of the $how program differ"
  done
done
timeout 200 "$tcsim" exec -- sh -c "$work/plain measured" >"$work/measured" 2>&1 || fail "measured: $(cat "$work/measured")"
