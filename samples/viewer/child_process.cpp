#include "samples/viewer/child_process.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX leaves declaring it to the program

namespace viewer
{
namespace
{

void redirect(posix_spawn_file_actions_t& actions, int stream, int descriptor)
{
    if (descriptor >= 0)
        (void)posix_spawn_file_actions_adddup2(&actions, descriptor, stream);
    else
        (void)posix_spawn_file_actions_addopen(&actions, stream, "/dev/null",
                                               stream == STDIN_FILENO ? O_RDONLY : O_WRONLY, 0);
}

void reset_signals(posix_spawnattr_t& attributes)
{
    sigset_t none;
    sigset_t ignored;
    (void)sigemptyset(&none);
    (void)sigemptyset(&ignored);
    (void)sigaddset(&ignored, SIGPIPE);
    (void)sigaddset(&ignored, SIGXFSZ);
    (void)posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    (void)posix_spawnattr_setpgroup(&attributes, 0);
    (void)posix_spawnattr_setsigmask(&attributes, &none);
    (void)posix_spawnattr_setsigdefault(&attributes, &ignored);
}

} // namespace

int start_program(std::vector<std::string> arguments, const ChildStreams& streams, pid_t& process)
{
    std::vector<char*> pointers;
    for (std::string& argument : arguments)
        pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawnattr_init(&attributes);
    redirect(actions, STDIN_FILENO, streams.input);
    redirect(actions, STDOUT_FILENO, streams.output);
    redirect(actions, STDERR_FILENO, streams.errors);
    reset_signals(attributes);
    const int problem = posix_spawnp(&process, pointers[0], &actions, &attributes, pointers.data(), environ);
    (void)posix_spawnattr_destroy(&attributes);
    (void)posix_spawn_file_actions_destroy(&actions);
    return problem;
}

bool is_missing(int problem, const std::string& program)
{
    return problem == ENOENT || (problem == EACCES && program.find('/') == std::string::npos);
}

int wait_for_program(pid_t process)
{
    int status = -1;
    while (process > 0 && ::waitpid(process, &status, 0) < 0 && errno == EINTR)
    {
    }
    return status;
}

} // namespace viewer
