// Files in which programs read about their computer. The coordinator opens these files, and finds
// out which they are; the functions here only tell which files are certainly none of them. The open
// of such a file is made so that it is trapped, as an open is that the program makes raw.
// Async-signal-safe; errno stays as it is.
#pragma once

namespace tcs::preload {

// Whether the coordinator is to be asked for a file that is opened so.
bool MayBeOfComputer(int folder, const char* path, int flags);

// The coordinator's answer, or the kernel's if the file is another one: a descriptor, or -errno.
long OpenOfComputer(int folder, const char* path, int flags);

// Opens a file in the folders of the processors: a robot may have more processors than its host. As
// OpenOfComputer, for a caller that asks about a name there; negative for other names, too. The
// name can be read.
long OpenProcessorFolder(const char* path, int flags);

// The program has gone back to the beginning of the file that the descriptor reads. The program
// finds the contents of now there, if the file is one of these files.
void ReadAnew(int fd);

}  // namespace tcs::preload
