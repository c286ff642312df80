// SPDX-License-Identifier: Apache-2.0
// hold_thread TID: stops one thread of another process until that process dies. SIGSTOP would stop
// all of its threads; a tracer can stop one.
#include <cstdio>
#include <cstdlib>

#include <sys/ptrace.h>
#include <sys/wait.h>

int main(int argc, char** argv) {
  const pid_t thread = argc == 2 ? std::atoi(argv[1]) : 0;
  int state = 0;
  const bool held = thread > 0 && ptrace(PTRACE_SEIZE, thread, nullptr, nullptr) == 0 &&
                    ptrace(PTRACE_INTERRUPT, thread, nullptr, nullptr) == 0 &&
                    waitpid(thread, &state, __WALL) == thread && WIFSTOPPED(state);
  if (!held) {
    std::perror("hold_thread");
    return 1;
  }
  std::puts("held");
  std::fflush(stdout);
  while (waitpid(thread, &state, __WALL) == thread && WIFSTOPPED(state)) continue;
  return 0;
}
