/* tcs: what a program that knows of the simulation can tell it. No program has to.
 *
 * Programs that talk by sockets, pipes or DDS need none of this: at each virtual time they see what
 * was sent before it. But tcs does not see memory and files that programs share. For these, a
 * program says by this library when it reads and when it writes, as in "Making Time Make Sense in
 * Robotic Simulation" (Taylor, Drumwright, Parmer): read, write, idle; and mark, where one
 * activation ends and the next begins.
 *
 *   for (int64_t next = tcs_now();; next += 1000000) {
 *     tcs_idle(next);
 *     tcs_read();      // all that others have written before now is there, and nothing later
 *     const struct state seen = *shared;
 *     ...
 *     tcs_write();     // no program can read any more what was before now
 *     shared->command = command;
 *   }
 *
 * Outside a run, read, write and mark do nothing, idle sleeps in real time, and now reads the
 * system's clock. Any thread may call these functions. A signal handler may call all but tcs_idle.
 * errno is kept.
 * Link with -ltcs (`pkg-config --libs tcs`), or with tcs::tcs of find_package(tcs).
 */
#ifndef TCS_TCS_H
#define TCS_TCS_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* 1 if the process is in a run of tcs, else 0. */
int tcs_is_running(void);

/* CLOCK_MONOTONIC in nanoseconds: in a run virtual time. Never goes backwards. */
int64_t tcs_now(void);

/* Ends an activation of the calling thread and begins the next one, for activations.csv and the
 * report. For loops that never wait; a thread that waits has activations without it. */
void tcs_mark(void);

/* Returns once all other threads have come to this thread's time. All that they have written before
 * that time is then there. Later writes are not, if the writers call tcs_write. */
void tcs_read(void);

/* Returns once no other thread can still read at an earlier time by tcs_read. The caller's writes
 * then count as written at its time. */
void tcs_write(void);

/* Sleeps until tcs_now() is `until_ns`; at once if that time is over. Returns 0, or EINTR if a
 * signal handler has run before. */
int tcs_idle(int64_t until_ns);

#ifdef __cplusplus
}
#endif

#endif
