/// Proof, at import, that YADE's classes lie in memory as `yade_classes.hpp` declares them.
#include "engines/seam/layout.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>
#include <utility>

#include "engines/seam/memory_probe.hpp"
#include "engines/seam/yade.hpp"

#pragma GCC diagnostic ignored "-Winvalid-offsetof"  // the point of this file

namespace graindrive::seam {
namespace {

namespace py = boost::python;
using std::string;
using Address = std::uintptr_t;

constexpr const char* proven_version = "2023.02a";

[[noreturn]] void refuse(const string& what)
{
	const string message = "graindrive does not fit this YADE: " + what +
	                       ". Graindrive's engines were not loaded. Use Debian 12's YADE " + proven_version +
	                       ", or build Graindrive against your YADE's source tree (cmake -DYADE_INCLUDE_DIR=...).";
	PyErr_SetString(PyExc_ImportError, message.c_str());
	py::throw_error_already_set();
	throw std::logic_error("unreachable");
}

Address address_of(const py::object& object) { return reinterpret_cast<Address>(&py::extract<yade::Serializable&>(object)()); }

string symbol_at(Address code)
{
	Dl_info info;
	if (!dladdr(reinterpret_cast<void*>(code), &info) || !info.dli_sname) return "(no symbol)";
	int status = 0;
	char* name = abi::__cxa_demangle(info.dli_sname, nullptr, nullptr, &status);
	const string result = status == 0 ? name : info.dli_sname;
	free(name);
	return result;
}

template <class T>
string raw(const T& value)
{
	return string(reinterpret_cast<const char*>(&value), sizeof value);
}

class Proof {
public:
	explicit Proof(const py::dict& damage)
		: damage_(damage),
		  yade_(py::import("yade.wrapper")),
		  eigen_(py::import("yade.minieigenHP"))
	{
	}

	int run()
	{
		if (!probe_.usable()) refuse("cannot read /proc/self/mem, which the proof of its class layout needs (mount /proc)");
		version();
		sizes();
		engine_and_functors();
		state();
		body_and_shape();
		interaction();
		contact();
		scene();
		virtual_functions();
		every_damage_was_done();
		return facts_;
	}

	/// What `damage` may name, in the order of the proof.
	const std::vector<string>& members() const { return members_; }

private:
	py::object make(const char* cls) const { return yade_.attr(cls)(); }

	std::size_t declared(const string& member, std::size_t offset)
	{
		members_.push_back(member);
		return offset + py::extract<int>(damage_.get(member, 0));
	}

	/// A misspelt name would let the test of the proof pass for nothing.
	void every_damage_was_done() const
	{
		const py::list names = damage_.keys();
		for (long i = 0; i < py::len(names); ++i) {
			const string name = py::extract<string>(names[i]);
			if (std::find(members_.begin(), members_.end(), name) == members_.end())
				throw std::invalid_argument(
					"damage names '" + name + "', which the proof does not look at; proven_members() lists what it does");
		}
	}

	/// The declared place of a member must hold these bytes; where it does not, say where they are.
	void holds(const string& member, const py::object& object, std::size_t offset, const string& sentinel)
	{
		const Address start = address_of(object);
		const std::size_t at = declared(member, offset);
		++facts_;
		if (probe_.bytes(start + at, sentinel.size()) == sentinel) return;
		const std::size_t found = memory_of(object).find(sentinel, 24);
		misplaced(member, at, found);
	}
	[[noreturn]] static void misplaced(const string& member, std::size_t at, std::size_t found)
	{
		std::ostringstream message;
		message << member << " is expected at byte " << at << " but ";
		if (found == string::npos)
			message << "its value was not found in the object";
		else
			message << "was found at byte " << found;
		refuse(message.str());
	}
	string memory_of(const py::object& object) const
	{
		const Address start = address_of(object);
		return probe_.bytes(start, malloc_usable_size(reinterpret_cast<void*>(start)));
	}

	/// Sets an attribute by YADE's own means (which reaches read-only ones too), then looks for it.
	template <class T>
	void attribute(const string& cls, const string& name, const py::object& object, std::size_t offset, const py::object& value,
		const T& bytes)
	{
		py::dict update;
		update[name] = value;
		object.attr("updateAttrs")(update);
		holds(cls + "." + name, object, offset, raw(bytes));
	}
	void real(const string& cls, const string& name, const py::object& object, std::size_t offset)
	{
		const Real value = next();
		attribute(cls, name, object, offset, py::object(value), value);
	}
	void vector(const string& cls, const string& name, const py::object& object, std::size_t offset)
	{
		const Real v[3] = { next(), next(), next() };
		attribute(cls, name, object, offset, eigen_.attr("Vector3")(v[0], v[1], v[2]), v);
	}
	template <class Integer>
	void integer(const string& cls, const string& name, const py::object& object, std::size_t offset)
	{
		const Integer value = static_cast<Integer>(0x11223300 + ++sentinel_);
		attribute(cls, name, object, offset, py::object(value), value);
	}
	/// A single byte may have the right value by chance: it must also change when YADE changes the flag.
	template <class Set>
	void flag(const string& member, const py::object& object, std::size_t offset, Set&& set)
	{
		const std::size_t at = declared(member, offset);
		set(false);
		const string cleared = memory_of(object);
		set(true);
		const string raised = memory_of(object);
		++facts_;
		if (at < raised.size() && !cleared[at] && raised[at] == 1) return;
		std::size_t found = 24;
		while (found < raised.size() && !(cleared[found] == 0 && raised[found] == 1)) ++found;
		misplaced(member, at, found < raised.size() ? found : string::npos);
	}
	void flag(const string& cls, const string& name, const py::object& object, std::size_t offset)
	{
		flag(cls + "." + name, object, offset, [&](bool value) {
			py::dict update;
			update[name] = value;
			object.attr("updateAttrs")(update);
		});
	}
	void pointer(const string& member, const py::object& object, std::size_t offset, const py::object& target)
	{
		holds(member, object, offset, raw(address_of(target)));
	}
	Real next() { return 1.0625e7 + 3 * ++sentinel_; }

	void version()
	{
		const string found = py::extract<string>(py::import("yade.config").attr("version"));
		++facts_;
#ifndef GRAINDRIVE_YADE_HEADERS
		if (found != proven_version) refuse("version is " + found + ", expected " + proven_version);
#endif
	}

	template <class T>
	void size(const char* cls)
	{
		const std::size_t expected = declared(string(cls) + ".size", sizeof(T));
		std::vector<py::object> objects;
		std::size_t block = string::npos;
		++facts_;
		// A block is the size rounded up to 8 modulo 16; one cut from a recycled block may have 16 bytes more, hence several tries.
		for (int attempt = 0; attempt < 64; ++attempt) {
			objects.push_back(make(cls));
			block = std::min(block, malloc_usable_size(reinterpret_cast<void*>(address_of(objects.back()))));
			if (block < expected) break;
			if (block < expected + 16) return;
		}
		if (expected <= block && block < expected + 32) return;  // a heap full of such blocks: the proof is 16 bytes coarser
		std::ostringstream message;
		message << cls << " is expected to take " << expected << " bytes but has a block of " << block;
		refuse(message.str());
	}
	/// Only classes that engines derive from: there a wrong size would put our members over YADE's. Where a Shape ends is known to the
	/// byte from Sphere.radius, the first member of a class derived from it.
	void sizes()
	{
		size<yade::Engine>("Engine");
		size<yade::LawFunctor>("LawFunctor");
		size<yade::IPhysFunctor>("IPhysFunctor");
		size<yade::FrictPhys>("FrictPhys");
		size<yade::BoundFunctor>("BoundFunctor");
		size<yade::IGeomFunctor>("IGeomFunctor");
#ifndef GRAINDRIVE_YADE_HEADERS
		static_assert(offsetof(yade::Sphere, radius) == sizeof(yade::Shape));
		static_assert(offsetof(yade::State, ori) - offsetof(yade::State, pos) == offsetof(yade::Se3r, orientation));
#endif
	}

	void label(const char* cls, std::size_t offset)
	{
		py::object object = make(cls);
		object.attr("label") = "sentinel";
		const auto length = raw(std::size_t(8)) + "sentinel";
		holds(string(cls) + ".label", object, offset + 8, length);  // std::string: data pointer, length, short text
	}
	void engine_and_functors()
	{
		py::object engine = make("Engine");
		integer<int>("Engine", "ompThreads", engine, offsetof(yade::Engine, ompThreads));
		flag("Engine", "dead", engine, offsetof(yade::Engine, dead));
		label("Engine", offsetof(yade::Engine, label));
		pointer("Engine.scene", engine, offsetof(yade::Engine, scene), py::import("yade").attr("O").attr("_sceneObj"));
		periodic_engine();
		label("LawFunctor", offsetof(yade::LawFunctor, label));
		label("IPhysFunctor", offsetof(yade::IPhysFunctor, label));
		label("BoundFunctor", offsetof(yade::BoundFunctor, label));
		label("IGeomFunctor", offsetof(yade::IGeomFunctor, label));
	}

	void periodic_engine()
	{
		py::object runner = make("PyRunner");
		real("PyRunner", "virtPeriod", runner, offsetof(yade::PeriodicEngine, virtPeriod));
		real("PyRunner", "realPeriod", runner, offsetof(yade::PeriodicEngine, realPeriod));
		real("PyRunner", "virtLast", runner, offsetof(yade::PeriodicEngine, virtLast));
		real("PyRunner", "realLast", runner, offsetof(yade::PeriodicEngine, realLast));
		integer<long>("PyRunner", "iterPeriod", runner, offsetof(yade::PeriodicEngine, iterPeriod));
		integer<long>("PyRunner", "iterLast", runner, offsetof(yade::PeriodicEngine, iterLast));
		integer<long>("PyRunner", "nDo", runner, offsetof(yade::PeriodicEngine, nDo));
		integer<long>("PyRunner", "nDone", runner, offsetof(yade::PeriodicEngine, nDone));
		integer<long>("PyRunner", "firstIterRun", runner, offsetof(yade::PeriodicEngine, firstIterRun));
		flag("PyRunner", "initRun", runner, offsetof(yade::PeriodicEngine, initRun));
	}

	void state()
	{
		py::object state = make("State");
		vector("State", "vel", state, offsetof(yade::State, vel));
		vector("State", "angVel", state, offsetof(yade::State, angVel));
		vector("State", "angMom", state, offsetof(yade::State, angMom));
		vector("State", "inertia", state, offsetof(yade::State, inertia));
		vector("State", "refPos", state, offsetof(yade::State, refPos));
		real("State", "mass", state, offsetof(yade::State, mass));
		real("State", "densityScaling", state, offsetof(yade::State, densityScaling));
		const Real position[3] = { next(), next(), next() };
		state.attr("pos") = eigen_.attr("Vector3")(position[0], position[1], position[2]);
		holds("State.pos", state, offsetof(yade::State, pos), raw(position));
		const Real unit[4] = { 0.5, -0.5, 0.5, 0.5 };  // stored x, y, z, w; made from w, x, y, z
		state.attr("ori") = eigen_.attr("Quaternion")(unit[3], unit[0], unit[1], unit[2]);
		holds("State.ori", state, offsetof(yade::State, ori), raw(unit));
		state.attr("blockedDOFs") = "xZ";
		flag("State", "isDamped", state, offsetof(yade::State, isDamped));
		holds("State.blockedDOFs", state, offsetof(yade::State, blockedDOFs),
			raw(unsigned(yade::State::DOF_X | yade::State::DOF_RZ)));
	}

	void shape_and_bound()
	{
		py::object shape = make("Shape"), box = make("Aabb");
		vector("Shape", "color", shape, offsetof(yade::Shape, color));
		flag("Shape", "wire", shape, offsetof(yade::Shape, wire));
		flag("Shape", "highlight", shape, offsetof(yade::Shape, highlight));
		vector("Aabb", "color", box, offsetof(yade::Aabb, color));
		vector("Aabb", "min", box, offsetof(yade::Aabb, min));
		vector("Aabb", "max", box, offsetof(yade::Aabb, max));
		made_by_name("Aabb");
		made_by_name("ScGeom");
		class_index(shape);
	}
	/// The class factory, without which no dispatcher finds a shape's class.
	void made_by_name(const char* cls)
	{
		const auto object = Singleton<yade::ClassFactory>::instance().createShared(cls);
		++facts_;
		if (!object || object->getClassName() != cls) refuse(string("YADE's class factory does not make a ") + cls);
	}
	/// The root has no index of its own; a class derived from it has the index that Python's dispIndex tells.
	void class_index(const py::object& root)
	{
		const auto index = [](const py::object& object) { return py::extract<yade::Shape&>(object)().getClassIndex(); };
		py::object sphere = make("Sphere");
		const int most = py::extract<yade::Shape&>(sphere)().getMaxCurrentlyUsedClassIndexOfKin();
		++facts_;
		if (index(root) == -1 && index(sphere) == py::extract<int>(sphere.attr("dispIndex"))() && index(sphere) <= most) return;
		refuse("Shape.getClassIndex does not tell the index that dispatchers use");
	}

	void body_and_shape()
	{
		shape_and_bound();
		py::object body = make("Body"), material = make("FrictMat"), shape = make("Sphere"), state = make("State");
		integer<int>("Body", "id", body, offsetof(yade::Body, id));
		integer<int>("Body", "flags", body, offsetof(yade::Body, flags));
		integer<int>("Body", "clumpId", body, offsetof(yade::Body, clumpId));
		integer<int>("Body", "groupMask", body, offsetof(yade::Body, groupMask));
		body.attr("mat") = material;
		body.attr("shape") = shape;
		body.attr("state") = state;
		pointer("Body.material", body, offsetof(yade::Body, material), material);
		pointer("Body.shape", body, offsetof(yade::Body, shape), shape);
		pointer("Body.state", body, offsetof(yade::Body, state), state);
		empty_map("Body.intrs", body, offsetof(yade::Body, intrs));
		empty_map("Clump.members", make("Clump"), offsetof(yade::Clump, members));
		place_in_clump();
		real("Sphere", "radius", shape, offsetof(yade::Sphere, radius));
		real("FrictMat", "young", material, offsetof(yade::FrictMat, young));
		real("FrictMat", "poisson", material, offsetof(yade::FrictMat, poisson));
		real("FrictMat", "frictionAngle", material, offsetof(yade::FrictMat, frictionAngle));
		real("FrictMat", "density", material, offsetof(yade::FrictMat, density));
	}
	/// An empty std::map: no root, leftmost and rightmost point at the map's own header, no elements.
	void empty_map(const string& member, const py::object& object, std::size_t offset)
	{
		const string memory = memory_of(object);
		const Address start = address_of(object);
		const auto is_map = [&](std::size_t at) {
			const Address header = start + at + 8;
			const Address expected[4] = { 0, header, header, 0 };
			return at + 48 <= memory.size() && memory.compare(at + 16, sizeof expected, raw(expected)) == 0;
		};
		const std::size_t at = declared(member, offset);
		++facts_;
		if (is_map(at)) return;
		std::size_t found = 24;
		while (found + 48 <= memory.size() && !is_map(found)) found += 8;
		misplaced(member, at, is_map(found) ? found : string::npos);
	}

	/// A member that is put into the declared map must come back out of YADE's own list of members.
	void place_in_clump()
	{
		py::object clump = make("Clump");
		auto& members = *reinterpret_cast<decltype(yade::Clump::members)*>(address_of(clump) + offsetof(yade::Clump, members));
		const Real position[3] = { next(), next(), next() };
		members[7] = { { position[0], position[1], position[2] }, { 0.5, -0.5, 0.5, 0.5 } };  // x, y, z, w
		const py::object found = clump.attr("members").attr("get")(7);
		++facts_;
		if (!found.is_none() && found[0] == eigen_.attr("Vector3")(position[0], position[1], position[2]) &&
			found[1] == eigen_.attr("Quaternion")(0.5, 0.5, -0.5, 0.5))
			return;
		refuse("Clump.members does not hold places as position and orientation");
	}

	void interaction()
	{
		py::object contact = make("Interaction"), geom = make("ScGeom"), phys = make("FrictPhys");
#ifndef GRAINDRIVE_YADE_HEADERS  // there the ids are private
		integer<int>("Interaction", "id1", contact, offsetof(yade::Interaction, id1));
		integer<int>("Interaction", "id2", contact, offsetof(yade::Interaction, id2));
#endif
		flag("Interaction.isActive", contact, offsetof(yade::Interaction, isActive),
			[&](bool value) { contact.attr("isActive") = value; });  // no archived attribute, so updateAttrs does not know it
		integer<long>("Interaction", "iterMadeReal", contact, offsetof(yade::Interaction, iterMadeReal));
		const int images[3] = { 3, -7, 0x112233 };
		attribute("Interaction", "cellDist", contact, offsetof(yade::Interaction, cellDist),
			eigen_.attr("Vector3i")(images[0], images[1], images[2]), images);
		contact.attr("geom") = geom;
		contact.attr("phys") = phys;
		pointer("Interaction.geom", contact, offsetof(yade::Interaction, geom), geom);
		pointer("Interaction.phys", contact, offsetof(yade::Interaction, phys), phys);
	}

	void contact()
	{
		py::object geom = make("ScGeom"), phys = make("FrictPhys");
		vector("ScGeom", "normal", geom, offsetof(yade::ScGeom, normal));
		vector("ScGeom", "contactPoint", geom, offsetof(yade::ScGeom, contactPoint));
		real("ScGeom", "refR1", geom, offsetof(yade::ScGeom, refR1));
		real("ScGeom", "refR2", geom, offsetof(yade::ScGeom, refR2));
		real("ScGeom", "penetrationDepth", geom, offsetof(yade::ScGeom, penetrationDepth));
		real("FrictPhys", "kn", phys, offsetof(yade::FrictPhys, kn));
		real("FrictPhys", "ks", phys, offsetof(yade::FrictPhys, ks));
		vector("FrictPhys", "normalForce", phys, offsetof(yade::FrictPhys, normalForce));
		vector("FrictPhys", "shearForce", phys, offsetof(yade::FrictPhys, shearForce));
		real("FrictPhys", "tangensOfFrictionAngle", phys, offsetof(yade::FrictPhys, tangensOfFrictionAngle));
	}

	void scene()
	{
		py::object scene = make("Scene");  // a scene of our own: the user's is not touched
		real("Scene", "dt", scene, offsetof(yade::Scene, dt));
		real("Scene", "time", scene, offsetof(yade::Scene, time));
		real("Scene", "stopAtTime", scene, offsetof(yade::Scene, stopAtTime));
		integer<long>("Scene", "iter", scene, offsetof(yade::Scene, iter));
		integer<long>("Scene", "stopAtIter", scene, offsetof(yade::Scene, stopAtIter));
		integer<int>("Scene", "subStep", scene, offsetof(yade::Scene, subStep));
		flag("Scene", "isPeriodic", scene, offsetof(yade::Scene, isPeriodic));
		points_to("Scene.bodies", scene, offsetof(yade::Scene, bodies), "vtable for yade::BodyContainer");
		points_to("Scene.interactions", scene, offsetof(yade::Scene, interactions), "vtable for yade::InteractionContainer");
		points_to("Scene.cell", scene, offsetof(yade::Scene, cell), "vtable for yade::Cell");
		cell();
		engine_list();
		forces(scene);
	}
	void cell()
	{
		py::object periodic = make("Cell");
		const Real edges[9] = { next(), 0, 0, 0, next(), 0, 0, 0, next() };
		const py::object matrix = eigen_.attr("Matrix3")(edges[0], 0, 0, 0, edges[4], 0, 0, 0, edges[8]);
		attribute("Cell", "hSize", periodic, offsetof(yade::Cell, hSize), matrix, edges);
		holds("Cell.prevHSize", periodic, offsetof(yade::Cell, prevHSize), raw(edges));  // YADE sets it to hSize
		integer<int>("Cell", "homoDeform", periodic, offsetof(yade::Cell, homoDeform));
		flag("Cell", "velGradChanged", periodic, offsetof(yade::Cell, velGradChanged));
		for (const auto& [name, offset] :
			{ std::pair("trsf", offsetof(yade::Cell, trsf)), std::pair("refHSize", offsetof(yade::Cell, refHSize)),
				std::pair("velGrad", offsetof(yade::Cell, velGrad)), std::pair("nextVelGrad", offsetof(yade::Cell, nextVelGrad)),
				std::pair("prevVelGrad", offsetof(yade::Cell, prevVelGrad)) }) {
			const Real rates[9] = { next(), 0, 0, 0, next(), 0, 0, 0, next() };
			attribute(
				"Cell", name, periodic, offset, eigen_.attr("Matrix3")(rates[0], 0, 0, 0, rates[4], 0, 0, 0, rates[8]), rates);
		}
	}
	void points_to(const string& member, const py::object& object, std::size_t offset, const string& vtable)
	{
		const auto target = probe_.read<Address>(address_of(object) + declared(member, offset));
		const auto vptr = target ? probe_.read<Address>(*target) : std::nullopt;
		++facts_;
		if (vptr && symbol_at(*vptr) == vtable) return;
		refuse(member + " is expected to point at an object with " + vtable + " but has " +
			   (vptr ? symbol_at(*vptr) : "no pointer"));
	}
	/// O.engines is put back as it was.
	void engine_list()
	{
		py::object omega = py::import("yade").attr("O"), before = omega.attr("engines"), engine = make("Engine");
		py::list one;
		one.append(engine);
		omega.attr("engines") = one;
		const auto begin =
			probe_.read<Address>(address_of(omega.attr("_sceneObj")) + declared("Scene.engines", offsetof(yade::Scene, engines)));
		const auto first = begin ? probe_.read<Address>(*begin) : std::nullopt;
		omega.attr("engines") = before;
		++facts_;
		if (!first || *first != address_of(engine)) refuse("Scene.engines does not lead to the first engine of O.engines");
	}
	/// A vector of arrays, one a thread, at its start; then YADE's own functions must find there what they put there.
	void forces(const py::object& scene)
	{
		const Address start = address_of(scene) + declared("Scene.forces", offsetof(yade::Scene, forces));
		const auto first = probe_.read<Address>(start), last = probe_.read<Address>(start + 8);
		++facts_;
		if (!first || !last || *last <= *first || (*last - *first) % sizeof(std::vector<Vector3r>) != 0 ||
			*last - *first > 1u << 16)
			refuse("Scene.forces does not start with YADE's arrays of forces, one a thread");
		const Vector3r sentinel(next(), next(), next());
		auto* container = reinterpret_cast<yade::ForceContainer*>(start);
		container->addForce(1, sentinel);
		const auto data = probe_.read<Address>(*first);
		const auto found = data ? probe_.read<std::array<Real, 3>>(*data + sizeof(Vector3r)) : std::nullopt;
		++facts_;
		if (!found || std::memcmp(found->data(), sentinel.data(), sizeof *found) != 0)
			refuse("a force added to Scene.forces was not found in its arrays");
		sync_count(container, start);
	}
	/// The counter must rise by one where something was added, and stay where nothing was.
	void sync_count(yade::ForceContainer* container, Address start)
	{
		const Address place = start + declared("ForceContainer.syncCount", offsetof(yade::ForceContainer, syncCount));
		const auto counted = [&] { return probe_.read<long>(place).value_or(-1); };
		const long before = counted();
		container->sync();
		const long after = counted();
		container->sync();
		++facts_;
		if (after != before + 1 || counted() != after) refuse("ForceContainer.syncCount does not count at byte 288");
		container->reset(0);
	}

	/// Slot by slot, the symbols behind an object's vptr.
	void slots(
		const string& cls, const py::object& object, std::size_t vptr_offset, int first, const std::vector<string>& expected)
	{
		const auto vptr = probe_.read<Address>(address_of(object) + vptr_offset);
		for (std::size_t i = 0; i < expected.size(); ++i) {
			const auto code = vptr ? probe_.read<Address>(*vptr + (first + i) * sizeof(Address)) : std::nullopt;
			const string found = code ? symbol_at(*code) : "nothing";
			++facts_;
			if (found.find(expected[i]) != string::npos) continue;
			std::ostringstream message;
			message << "virtual function " << first + i << " of " << cls << " is expected to be " << expected[i] << " but is "
					<< found;
			refuse(message.str());
		}
	}
	void virtual_functions()
	{
		const std::vector<string> serializable{ "::getBaseClassName", "::getBaseClassNumber", "::getClassName", "::pySetAttr",
			"::pyDict", "::pyDictCustom", "::callPostLoad", "::checkPyClassRegistersItself", "::pyRegisterClass",
			"::pyHandleCustomCtorArgs" };
		py::object engine = make("Engine"), law = make("LawFunctor"), iphys = make("IPhysFunctor"), phys = make("FrictPhys");
		py::object bound = make("BoundFunctor"), igeom = make("IGeomFunctor"), shape = make("Shape");
		for (const auto& [cls, object] :
			std::vector<std::pair<string, py::object>>{ { "Engine", engine }, { "LawFunctor", law }, { "IPhysFunctor", iphys },
				{ "FrictPhys", phys }, { "BoundFunctor", bound }, { "IGeomFunctor", igeom }, { "Shape", shape } }) {
			slots(cls, object, 0, 0, { "::~" + cls, "::~" + cls });
			slots(cls, object, 0, 2, serializable);
		}
		slots("Engine", engine, 0, 12, { "yade::Engine::isActivated()", "yade::Engine::action()" });
		for (const auto& [cls, object] :
			std::vector<std::pair<string, py::object>>{ { "FrictPhys", phys }, { "Shape", shape } }) {
			slots(cls, object, 0, 12,
				{ "::modifyClassIndex", "::getClassIndex", "::getBaseClassIndex", "::getMaxCurrentlyUsedClassIndexOfKin",
					"::incrementMaxCurrentlyUsedClassIndexOfKin" });
			slots(cls + " (Indexable)", object, 24, 0,
				{ "::incrementMaxCurrentlyUsedClassIndexOfKin", "::modifyClassIndex", "::~" + cls, "::~" + cls, "::getClassIndex",
					"::getBaseClassIndex", "::getMaxCurrentlyUsedClassIndexOfKin" });
		}
		std::vector<string> wrapper{ "::checkOrder" };
		for (const char* name : { "::go(", "::goReverse(" }) wrapper.insert(wrapper.end(), 7, name);
		for (const auto& [cls, object] : std::vector<std::pair<string, py::object>>{
				 { "LawFunctor", law }, { "IPhysFunctor", iphys }, { "BoundFunctor", bound }, { "IGeomFunctor", igeom } }) {
			slots(cls, object, 0, 12, { "::getFunctorTypes" });
			if (cls == "BoundFunctor")
				slots(cls, object, 0, 13, { "::get1DFunctorType1" });
			else
				slots(cls, object, 0, 13, { "::get2DFunctorType1", "::get2DFunctorType2" });
			slots(cls + " (wrapper)", object, 80, 0, { "::~" + cls, "::~" + cls });
			slots(cls + " (wrapper)", object, 80, 2, wrapper);
		}
		slots("IGeomFunctor", igeom, 0, 15, { "yade::IGeomFunctor::preStep()" });
	}

	py::dict damage_;
	py::object yade_, eigen_;
	MemoryProbe probe_;
	std::vector<string> members_;
	int facts_ = 0;
	int sentinel_ = 0;
};

}  // namespace

int prove_layout(const py::dict& damage) { return Proof(damage).run(); }

namespace {

py::list proven_members()
{
	Proof proof({});
	proof.run();
	py::list names;
	for (const string& member : proof.members())
		if (!names.contains(member)) names.append(member);
	return names;
}

}  // namespace

void bind_layout()
{
	py::def("prove_layout", prove_layout, (py::arg("damage") = py::dict()),
		"Prove that YADE's classes lie in memory as Graindrive's engines expect.\n\n"
		"damage: {'State.vel': 8} shifts a declared offset by bytes (for the test that the proof can fail).\n"
		"Returns the number of facts proven. Raises ImportError naming class, member, expected and found, ValueError for a name\n"
		"that the proof does not look at.");
	py::def("proven_members", proven_members,
		"The names that prove_layout's damage may have: members as 'Class.member', sizes as 'Class.size'.");
}

}  // namespace graindrive::seam
