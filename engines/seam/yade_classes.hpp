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

/// Classes that dispatchers tell apart by an index.
class Indexable {
public:
	virtual void incrementMaxCurrentlyUsedClassIndexOfKin();
	virtual int& modifyClassIndex();
	virtual ~Indexable();
	virtual const int& getClassIndex() const;
	virtual const int& getBaseClassIndex(int depth) const;
	virtual const int& getMaxCurrentlyUsedClassIndexOfKin() const;
};

/// A base of YADE's that engines read but never derive from: Serializable and Indexable, no more.
class IndexableLayout : public Serializable {
	void* indexable_;  // the second vptr
};

class Bound;

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

class Shape : public IndexableLayout {
	char looks_[64];  // colour, wire, highlight, drawing
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
	char transformations_[712];

public:
	Eigen::Matrix<Real, 3, 3> hSize;  ///< columns are the edges

private:
	char previous_size_[72];

public:
	Eigen::Matrix<Real, 3, 3> velGrad;      ///< of the step
	Eigen::Matrix<Real, 3, 3> nextVelGrad;  ///< of the next one: what Python's O.cell.velGrad sets
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

/// The second base of a functor, with a vptr of its own: an overload of `go` and `goReverse` for every number of arguments.
template <class Result, class A, class B, class C>
class FunctorWrapperLayout {
public:
	virtual ~FunctorWrapperLayout() = default;
	virtual std::string checkOrder() const { return ""; }
	virtual Result go1_() { throw std::logic_error("unused overload of go"); }
	virtual Result go2_() { throw std::logic_error("unused overload of go"); }
	virtual Result go(A, B, C) { throw std::logic_error("go is not overridden"); }
	virtual Result go4_() { throw std::logic_error("unused overload of go"); }
	virtual Result go5_() { throw std::logic_error("unused overload of go"); }
	virtual Result go6_() { throw std::logic_error("unused overload of go"); }
	virtual Result go7_() { throw std::logic_error("unused overload of go"); }
	virtual Result reverse1_() { throw std::logic_error("unused overload of goReverse"); }
	virtual Result reverse2_() { throw std::logic_error("unused overload of goReverse"); }
	virtual Result goReverse(A, B, C) { throw std::logic_error("goReverse is not overridden"); }
	virtual Result reverse4_() { throw std::logic_error("unused overload of goReverse"); }
	virtual Result reverse5_() { throw std::logic_error("unused overload of goReverse"); }
	virtual Result reverse6_() { throw std::logic_error("unused overload of goReverse"); }
	virtual Result reverse7_() { throw std::logic_error("unused overload of goReverse"); }
};

/// YADE's multimethod on two types: `go` with three arguments is the one that its dispatchers call.
template <class Result, class A, class B, class C>
class BinaryDispatchFunctor : public Functor, public FunctorWrapperLayout<Result, A, B, C> {
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

}  // namespace yade
