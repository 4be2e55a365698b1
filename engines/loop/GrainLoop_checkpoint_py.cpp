/// Python binding of GrainLoop: checkpoints.
#include "engines/loop/checkpoint.hpp"
#include "engines/loop/GrainLoop_py.hpp"

namespace graindrive {
namespace {

py::object bytes(const std::string& text)
{
	return py::object(py::handle<>(PyBytes_FromStringAndSize(text.data(), Py_ssize_t(text.size()))));
}

std::string text_of(const py::object& bytes)
{
	char* start = nullptr;
	Py_ssize_t size = 0;
	if (PyBytes_AsStringAndSize(bytes.ptr(), &start, &size) != 0) py::throw_error_already_set();
	return { start, std::size_t(size) };
}

void checkpoint(GrainLoop& loop, const std::string& path, const py::object& saved_scene)
{
	const Running running(loop);
	loop.save_checkpoint(path, text_of(saved_scene));
}

py::object saved_scene(const std::string& path)
{
	const bool by_yade = loop::contents_of(path) == loop::Contents::yade_scene;
	return bytes(by_yade ? loop::read_checkpoint(path, loop::Contents::yade_scene) : GrainLoop::saved_scene(path));
}

void seal_scene(const std::string& path, const py::object& saved_scene)
{
	loop::write_checkpoint(path, text_of(saved_scene), loop::Contents::yade_scene);
}

void restore(GrainLoop& loop, const std::string& path)
{
	loop.scene = scene_of_yade();
	loop.restore_checkpoint(path);
}

}  // namespace

void bind_checkpoint(GrainLoopClass& cls)
{
	cls.def("checkpoint", checkpoint, (py::arg("path"), py::arg("saved_scene") = bytes("")),
		"Write loop, bodies, drives and measures into one file; a run restored from it continues with the same bits. Of other\n"
		"engines (PyRunner, recorders) it stores only the names. saved_scene: bytes that O.save wrote, to be stored too, as\n"
		"graindrive.scenes.scene.save does. Raises RuntimeError with the system's reason if the file cannot be written; an\n"
		"older file is then kept.");
	cls.def("restore", restore, (py::arg("path")),
		"Continue from a checkpoint in the same scene, built again or loaded: positions, velocities, O.iter and the state of\n"
		"drives and measures come from the file; threads, syncEvery, largestOverlap and bounds do not change. Raises\n"
		"RuntimeError with the reason, and changes nothing, for a file that is damaged, truncated, of another program or of\n"
		"another version, and for a scene with other bodies, engines, time step or law.");
	py::def("saved_scene", saved_scene, (py::arg("path")),
		"The bytes of O.save that a checkpoint holds; empty if there are none. Raises RuntimeError like GrainLoop.restore.");
	py::def("seal_scene", seal_scene, (py::arg("path"), py::arg("saved_scene")),
		"Write bytes of O.save into a checkpoint of a scene on YADE's own loop, in one step, with checksum and version.");
}

}  // namespace graindrive
