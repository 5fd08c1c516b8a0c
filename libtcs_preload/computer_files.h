// Files in which programs read of their computer. The coordinator opens them, and finds out which
// they are; here is only told what is certainly none. Such an open is made so that it is trapped,
// as one is that the program makes raw. Async-signal-safe; errno stays as it is.
#pragma once

namespace tcs::preload {

// Whether the coordinator is to be asked for a file that is opened so.
bool MayBeOfComputer(int folder, const char* path, int flags);

// The coordinator's answer, or the kernel's if the file is another one: a descriptor, or -errno.
long OpenOfComputer(int folder, const char* path, int flags);

// What is in the folders of the processors: a robot may have more of them than its host. The same
// as OpenOfComputer, for who asks about a name there; negative for other names, too. The name can
// be read.
long OpenProcessorFolder(const char* path, int flags);

// The program has gone back to the beginning of what the descriptor reads: what it finds there is
// of now, if it is one of these files.
void ReadAnew(int fd);

}  // namespace tcs::preload
