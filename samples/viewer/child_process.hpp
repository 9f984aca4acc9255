// Programs that run beside the viewer: the encoder of films, the compiler of shaders.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace viewer
{

// Descriptors for a program's standard streams; -1: /dev/null.
struct ChildStreams
{
    int input = -1;
    int output = -1;
    int errors = -1;
};

// Starts a program that is looked up in PATH, and not by a shell. It has a process group of its own: Ctrl-C reaches the
// viewer alone, and the program can be ended with what it started. Its signals are as every program starts with them,
// whatever the viewer does with its own. Returns an errno, 0 for none.
int start_program(std::vector<std::string> arguments, const ChildStreams& streams, pid_t& process);

// Whether that errno says that there is no such program. EACCES also comes from a folder of PATH that may not be
// searched.
bool is_missing(int problem, const std::string& program);

// The status of a program that has ended, as of waitpid; -1 if there was none.
int wait_for_program(pid_t process);

} // namespace viewer
