/// Lets Python's other threads go on while C++ waits.
#pragma once
#include <boost/python.hpp>

namespace graindrive::seam {

/// Gives Python's lock back while it lives, if this thread holds it.
class WithoutPython {
public:
	WithoutPython() : held(Py_IsInitialized() && PyGILState_Check() ? PyEval_SaveThread() : nullptr) {}
	~WithoutPython()
	{
		if (held) PyEval_RestoreThread(held);
	}
	WithoutPython(const WithoutPython&) = delete;

private:
	PyThreadState* held;
};

/// Returns once no other thread holds Python's lock; at once where this one does.
inline void wait_for_python()
{
	if (!Py_IsInitialized() || PyGILState_Check()) return;
	PyGILState_Release(PyGILState_Ensure());
}

}  // namespace graindrive::seam
