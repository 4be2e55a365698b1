/// YADE's classes as Graindrive's engines see them: our own minimal declarations for Debian's YADE 2023.02a, which ships no headers.
///
/// Only what an engine uses has a name; the rest is padding. `seam/layout.cpp` proves every named offset, every size and the
/// order of the virtual functions against the running YADE before any engine may be made. A build with -DYADE_INCLUDE_DIR
/// uses YADE's own headers instead. No function here has a body that YADE exports: the linker takes YADE's.
#pragma once
#include <boost/make_shared.hpp>
#include <boost/python.hpp>
#include <boost/shared_ptr.hpp>
#include <boost/smart_ptr/enable_shared_from_this.hpp>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "engines/base/real.hpp"

template <class T>
class Singleton {
public:
	static T& instance();
};

namespace yade {

using boost::dynamic_pointer_cast;
using boost::make_shared;
using boost::shared_ptr;
using boost::static_pointer_cast;
using graindrive::Quaternionr;
using graindrive::Real;
using graindrive::Vector3r;
using Vector3i = Eigen::Matrix<int, 3, 1>;

/// Root of YADE's classes that the class factory can make: a vptr, then the weak self pointer.
class Factorable : public boost::enable_shared_from_this<Factorable> {
public:
	Factorable() = default;
	virtual ~Factorable();
	virtual std::string getBaseClassName(unsigned int i = 0) const;
	virtual int getBaseClassNumber() const;
	virtual std::string getClassName() const;
};

/// A class with attributes that Python and archives can read and write.
class Serializable : public Factorable {
public:
	Serializable() = default;
	~Serializable() override;
	virtual void pySetAttr(const std::string& key, const boost::python::object& value);
	virtual boost::python::dict pyDict() const;
	virtual boost::python::dict pyDictCustom() const;
	virtual void callPostLoad();
	virtual void checkPyClassRegistersItself(const std::string& className) const;
	virtual void pyRegisterClass(boost::python::object scope);
	virtual void pyHandleCustomCtorArgs(boost::python::tuple& args, boost::python::dict& kw);
};

class Scene;
class Interaction;

/// One link of O.engines; `action` runs once a step.
class Engine : public Serializable {
public:
	Engine();
	~Engine() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
	virtual bool isActivated();
	virtual void action();

	Scene* scene;  ///< the simulation, set by YADE before every step
private:
	char timing_[32];  // execution count and time, shared_ptr to timing deltas
public:
	bool dead;
	int ompThreads;
	std::string label;
};

/// An engine that acts from time to time: every so many steps, or so much model or wall time.
class PeriodicEngine : public Engine {
public:
	~PeriodicEngine() override;
	bool isActivated() override;

	Real virtPeriod;  ///< [s] of the model
	Real realPeriod;  ///< [s] of the clock
	long iterPeriod;
	long nDo;
	bool initRun;
	long firstIterRun;
	Real virtLast, realLast;
	long iterLast;
	long nDone;
};

/// Classes that dispatchers distinguish by an index.
class Indexable {
public:
	virtual void incrementMaxCurrentlyUsedClassIndexOfKin() = 0;
	virtual int& modifyClassIndex() = 0;
	virtual ~Indexable() = default;
	virtual const int& getClassIndex() const = 0;
	virtual const int& getBaseClassIndex(int depth) const = 0;
	virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const = 0;

protected:
	/// The constructor of every class with an index of its own calls this: the first object takes the next free index.
	void createIndex()
	{
		if (modifyClassIndex() != -1) return;
		incrementMaxCurrentlyUsedClassIndexOfKin();
		modifyClassIndex() = getMaxCurrentlyUsedClassIndexOfKin();
	}
};

/// A base of YADE's that engines read but never derive from: Serializable and Indexable, no more.
class IndexableLayout : public Serializable {
	void* indexable_;  // the second vptr
};

/// The box that the collider sees.
class Bound : public IndexableLayout {
	char update_[40];  // when and where it was last made

public:
	Vector3r color;
	Vector3r min, max;  ///< corners [m]; in a periodic cell those of the body's own image
};

class Aabb : public Bound {};

class Material : public IndexableLayout {
public:
	int id;
	std::string label;
	Real density;
};

class FrictMat : public Material {
public:
	Real young, poisson;
	Real frictionAngle;
};

class Shape : public Serializable, public Indexable {
public:
	Shape() = default;
	~Shape() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
	int& modifyClassIndex() override;
	const int& getClassIndex() const override;
	const int& getBaseClassIndex(int depth) const override;
	const int& getMaxCurrentlyUsedClassIndexOfKin() const override;
	void incrementMaxCurrentlyUsedClassIndexOfKin() override;

private:
	shared_ptr<void> cached_functors_[2];  // of bounds and of drawing

public:
	Vector3r color = Vector3r::Ones();
	bool wire = false, highlight = false;
};

class Sphere : public Shape {
public:
	Real radius;
};

/// The shape of a clump's body: its members' ids, each with its place in the clump.
class Clump : public Shape {
public:
	struct Place {
		Vector3r position;
		Real orientation[4];
	};
	std::map<int, Place> members;
};

/// Place and orientation, as functors of bounds are given them: the first members of State, where no alignment parts them.
struct Se3r {
	Vector3r position;
	Eigen::Quaternion<Real, Eigen::DontAlign> orientation;
};

/// Position, velocity and inertia of a body.
class State : public IndexableLayout {
	char references_and_mutex_[56];

public:
	Vector3r pos;
	Quaternionr ori;
	Vector3r vel;
	Real mass;
	Vector3r angVel;
	Vector3r angMom;
	Vector3r inertia;
	Vector3r refPos;
	Quaternionr refOri;
	unsigned blockedDOFs;
	bool isDamped;
	Real densityScaling;
	enum { DOF_NONE = 0, DOF_X = 1, DOF_Y = 2, DOF_Z = 4, DOF_RX = 8, DOF_RY = 16, DOF_RZ = 32, DOF_ALL = 63 };
};

class Body : public Serializable {
public:
	using id_t = int;
	using MapId2IntrT = std::map<id_t, shared_ptr<Interaction>>;
	enum { FLAG_BOUNDED = 1, FLAG_ASPHERICAL = 2 };

	id_t id;
	int groupMask;
	int flags;
	int subdomain;
	shared_ptr<Material> material;
	shared_ptr<State> state;
	shared_ptr<Shape> shape;
	shared_ptr<Bound> bound;
	MapId2IntrT intrs;  ///< contacts and near pairs by the partner's id
	int clumpId;

	id_t getId() const { return id; }
	bool isClump() const { return clumpId != -1 && id == clumpId; }
	bool isClumpMember() const { return clumpId != -1 && id != clumpId; }
	bool isAspherical() const { return flags & FLAG_ASPHERICAL; }
};

class BodyContainer : public Serializable {
public:
	std::size_t size() const;
	const shared_ptr<Body>& operator[](unsigned int id) const;
	bool exists(Body::id_t id) const;
};

class IGeom : public IndexableLayout {};

class GenericSpheresContact : public IGeom {
public:
	Vector3r normal;        ///< from body 1 to body 2
	Vector3r contactPoint;  ///< in body 1's image
	Real refR1, refR2;
};

class ScGeom : public GenericSpheresContact {
	char axes_[64];  // cached rotations, references to the radii
public:
	Real penetrationDepth;

	/// Sets the normal, the rotation since the last step and the increment of shear, from radii, overlap and contact point. With
	/// `avoid_ratcheting` velocities are those of spheres of these radii, without it those of the bodies' material at the contact.
	void precompute(const State& state1, const State& state2, const Scene* scene, const shared_ptr<Interaction>& interaction,
		const Vector3r& current_normal, bool is_new, const Vector3r& shift2, bool avoid_ratcheting);
};

class IPhys : public Serializable, public Indexable {
public:
	int& modifyClassIndex() override;
	const int& getClassIndex() const override;
	const int& getBaseClassIndex(int depth) const override;
	const int& getMaxCurrentlyUsedClassIndexOfKin() const override;
	void incrementMaxCurrentlyUsedClassIndexOfKin() override;
};

class NormPhys : public IPhys {
public:
	Real kn;
	Vector3r normalForce;  ///< on body 2
};

class NormShearPhys : public NormPhys {
public:
	Real ks;
	Vector3r shearForce;  ///< on body 2
};

class FrictPhys : public NormShearPhys {
public:
	FrictPhys();
	~FrictPhys() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
	int& modifyClassIndex() override;
	const int& getClassIndex() const override;
	const int& getBaseClassIndex(int depth) const override;

	Real tangensOfFrictionAngle;
};

class Interaction : public Serializable {
public:
	bool isActive;

private:
	alignas(8) char functor_cache_[56];

public:
	Body::id_t id1, id2;
	long iterMadeReal;
	long iterLastSeen;
	shared_ptr<IGeom> geom;
	shared_ptr<IPhys> phys;
	Vector3i cellDist;

	Body::id_t getId1() const { return id1; }
	Body::id_t getId2() const { return id2; }
	bool isReal() const { return geom && phys; }
};

/// Forces and torques on bodies, one set of arrays a thread.
class alignas(8) ForceContainer {
	char arrays_[288];

public:
	long syncCount;  ///< how often the threads' arrays were added up: `sync` counts only where something was added since

	void addForce(Body::id_t id, const Vector3r& force);
	void addTorque(Body::id_t id, const Vector3r& torque);
	const Vector3r getForceSingle(Body::id_t id);  ///< sum over threads, without synchronising
	const Vector3r getTorqueSingle(Body::id_t id);
	const Vector3r& getForce(Body::id_t id);  ///< after `sync`: sum over threads and the permanent force
	const Vector3r& getTorque(Body::id_t id);
	void sync();
	void reset(long iter, bool resetAll = false);  ///< permanent forces stay
	bool getPermForceUsed() const;
};

class InteractionContainer;

/// The periodic cell.
class Cell : public Serializable {
	char caches_[568];

public:
	Eigen::Matrix<Real, 3, 3> trsf;         ///< product of all deformations
	Eigen::Matrix<Real, 3, 3> refHSize;     ///< for pictures
	Eigen::Matrix<Real, 3, 3> hSize;        ///< columns are the edges; deformed with velGrad at the start of each step
	Eigen::Matrix<Real, 3, 3> prevHSize;    ///< before that
	Eigen::Matrix<Real, 3, 3> velGrad;      ///< of the motion that led to the present positions [1/s]
	Eigen::Matrix<Real, 3, 3> nextVelGrad;  ///< of the next one: what Python's O.cell.velGrad sets
	Eigen::Matrix<Real, 3, 3> prevVelGrad;
	int homoDeform;  ///< 1: where velGrad changes, bodies follow with velGrad x; 0: they do not; 2: with a convective term besides
	bool velGradChanged;  ///< nextVelGrad is to be taken, even if it is zero
};

class Scene : public Serializable {
	int host_name_max_;

public:
	ForceContainer forces;

private:
	char internals_[112];

public:
	Real dt;
	long iter;
	bool subStepping;
	int subStep;
	Real time;
	Real speed;
	long stopAtIter;
	Real stopAtTime;
	bool isPeriodic;

private:
	char tags_[55];

public:
	std::vector<shared_ptr<Engine>> engines;

private:
	char next_engines_[24];

public:
	shared_ptr<BodyContainer> bodies;
	shared_ptr<InteractionContainer> interactions;

private:
	char energy_materials_bound_[56];

public:
	shared_ptr<Cell> cell;
};

/// The program's one simulation; `Singleton<Omega>::instance()` is it.
class Omega {
public:
	bool isRunning();  ///< false in the last step before O.pause() takes hold, and in O.step()
};

/// What dispatchers call for a pair of types.
class Functor : public Serializable {
public:
	Functor() : scene(nullptr) {}
	~Functor() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
	virtual std::vector<std::string> getFunctorTypes() const;

	shared_ptr<void> timingDeltas;
	Scene* scene;
	std::string label;
};

/// The second base of a functor, with a vptr of its own: overloads of `go` for one to seven arguments, then as many of `goReverse`.
class FunctorWrapperBase {
public:
	virtual ~FunctorWrapperBase() = default;
	/// The order of types in which a functor on two types of shapes wants its arguments, "First Second".
	virtual std::string checkOrder() const { return ""; }
};

/// `count` overloads that YADE does not call for this kind of functor; `first` is the number of the first one.
template <class Before, int first, int count>
class UnusedOverloads : public UnusedOverloads<Before, first, count - 1> {
	virtual void unused(std::integral_constant<int, first + count - 1>) { throw std::logic_error("unused overload of go"); }
};
template <class Before, int first>
class UnusedOverloads<Before, first, 0> : public Before {
};

template <class Before, class Result, class... Arguments>
class Go : public Before {
public:
	virtual Result go(Arguments...) { throw std::logic_error("go is not overridden"); }
};
template <class Before, class Result, class... Arguments>
class GoReverse : public Before {
public:
	virtual Result goReverse(Arguments...) { throw std::logic_error("goReverse is not overridden"); }
};

/// Dispatchers call the overload of `go` that has as many arguments as their kind of functor.
template <class Result, class... Arguments>
class FunctorWrapperLayout
	: public UnusedOverloads<
		  GoReverse<
			  UnusedOverloads<Go<UnusedOverloads<FunctorWrapperBase, 1, sizeof...(Arguments) - 1>, Result, Arguments...>, 8, 6>,
			  Result, Arguments...>,
		  15, 7 - sizeof...(Arguments)> {
};

/// YADE's multimethod on one type.
template <class Result, class... Arguments>
class UnaryDispatchFunctor : public Functor, public FunctorWrapperLayout<Result, Arguments...> {
public:
	std::vector<std::string> getFunctorTypes() const override { return { get1DFunctorType1() }; }
	virtual std::string get1DFunctorType1() const { throw std::logic_error("get1DFunctorType1 is not overridden"); }
};

/// YADE's multimethod on two types.
template <class Result, class... Arguments>
class BinaryDispatchFunctor : public Functor, public FunctorWrapperLayout<Result, Arguments...> {
public:
	std::vector<std::string> getFunctorTypes() const override { return { get2DFunctorType1(), get2DFunctorType2() }; }
	virtual std::string get2DFunctorType1() const { throw std::logic_error("get2DFunctorType1 is not overridden"); }
	virtual std::string get2DFunctorType2() const { throw std::logic_error("get2DFunctorType2 is not overridden"); }
};

/// Contact law: `go` returns false when the contact is over and may be erased.
class LawFunctor : public BinaryDispatchFunctor<bool, shared_ptr<IGeom>&, shared_ptr<IPhys>&, Interaction*> {
public:
	LawFunctor() = default;
	~LawFunctor() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
};

/// Makes an interaction's `phys` from two materials.
class IPhysFunctor : public BinaryDispatchFunctor<void, const shared_ptr<Material>&, const shared_ptr<Material>&,
						 const shared_ptr<Interaction>&> {
public:
	IPhysFunctor() = default;
	~IPhysFunctor() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
};

/// Makes the box around a shape.
class BoundFunctor : public UnaryDispatchFunctor<void, const shared_ptr<Shape>&, shared_ptr<Bound>&, const Se3r&, const Body*> {
public:
	BoundFunctor() = default;
	~BoundFunctor() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
};

/// Makes an interaction's `geom` from two shapes: body 1's, body 2's, their states, the shift to the image of body 2 that touches,
/// whether to answer for bodies apart, the interaction. `go` returns false where they do not touch.
class IGeomFunctor : public BinaryDispatchFunctor<bool, const shared_ptr<Shape>&, const shared_ptr<Shape>&, const State&,
						 const State&, const Vector3r&, const bool&, const shared_ptr<Interaction>&> {
public:
	IGeomFunctor() = default;
	~IGeomFunctor() override;
	std::string getBaseClassName(unsigned int i = 0) const override;
	int getBaseClassNumber() const override;
	std::string getClassName() const override;
	void pySetAttr(const std::string& key, const boost::python::object& value) override;
	boost::python::dict pyDict() const override;
	void callPostLoad() override;
	void pyRegisterClass(boost::python::object scope) override;
	virtual void preStep();  ///< once a step before the pairs, on one thread: the place to raise an error
};

/// Makes objects by the names of their classes; dispatchers ask it for the class index of a type that a functor names.
class ClassFactory {
public:
	bool registerFactorable(
		std::string name, Factorable* (*create)(), shared_ptr<Factorable> (*create_shared)(), void* (*create_pure)());
	shared_ptr<Factorable> createShared(std::string name);
};

}  // namespace yade
