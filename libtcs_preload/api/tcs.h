/* tcs: what a program that knows of the simulation can say to it. No program has to.
 *
 * Programs that talk by sockets, pipes or DDS are told the truth at each virtual time as they are.
 * Memory that programs share, and files, are not seen by tcs: there this library says when a
 * program looks and when it changes something, as in "Making Time Make Sense in Robotic Simulation"
 * (Taylor, Drumwright, Parmer): read, write, idle; and mark, where one activation ends and the next
 * begins.
 *
 *   for (int64_t next = tcs_now();; next += 1000000) {
 *     tcs_idle(next);
 *     tcs_read();      // what others have written before now is there, and nothing later
 *     const struct state seen = *shared;
 *     ...
 *     tcs_write();     // nobody can look any more at what was before now
 *     shared->command = command;
 *   }
 *
 * Outside a run all of it is the system's: read, write and mark do nothing, idle sleeps and now
 * reads the clock. Any thread may call it, and a signal handler what is not idle. errno is kept.
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

/* An activation of the calling thread ends here, and the next one begins, for activations.csv and
 * the report: for loops that wait for nothing. What waits has its activations without it. */
void tcs_mark(void);

/* Returns once all others have come to this thread's time, so that what they do before it is done;
 * what they do later, they have not done yet if they call tcs_write. */
void tcs_read(void);

/* Returns once no other can still look at an earlier time by tcs_read: what is changed then is
 * changed now. */
void tcs_write(void);

/* Sleeps until tcs_now() is `until_ns`; at once if it is already. Returns 0, or EINTR if a signal
 * handler has run before. */
int tcs_idle(int64_t until_ns);

#ifdef __cplusplus
}
#endif

#endif
