/// Kills the process just before its n-th change of the file system; preloaded (LD_PRELOAD) and armed by kill_anywhere.py.
#include <csignal>
#include <cstdarg>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

long counted = 0, fatal = 0;  // changes so far; the one before which the process dies, 0: none

void count()
{
	if (++counted == fatal) kill(getpid(), SIGKILL);
}

template <class Function>
Function next(Function, const char* name)
{
	return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

}  // namespace

#define COUNTED(result, name, parameters, arguments)                                                                             \
	extern "C" result name parameters                                                                                            \
	{                                                                                                                            \
		static auto* const real = next(&name, #name);                                                                            \
		count();                                                                                                                 \
		return real arguments;                                                                                                   \
	}

extern "C" void arm(long at)
{
	counted = 0;
	fatal = at;
}

extern "C" long changes() { return counted; }

COUNTED(ssize_t, write, (int file, const void* from, size_t size), (file, from, size))
COUNTED(ssize_t, pwrite, (int file, const void* from, size_t size, off_t at), (file, from, size, at))
COUNTED(ssize_t, pwrite64, (int file, const void* from, size_t size, off64_t at), (file, from, size, at))
COUNTED(int, ftruncate, (int file, off_t size), (file, size))
COUNTED(int, ftruncate64, (int file, off64_t size), (file, size))
COUNTED(int, rename, (const char* from, const char* to), (from, to))
COUNTED(int, unlink, (const char* path), (path))
COUNTED(int, unlinkat, (int folder, const char* path, int flags), (folder, path, flags))
COUNTED(int, mkdir, (const char* path, mode_t mode), (path, mode))
COUNTED(int, rmdir, (const char* path), (path))
