/// YADE's classes: from its own headers where a source tree is given, else from the declarations that Graindrive proves at import.
#pragma once
#ifdef GRAINDRIVE_YADE_HEADERS
#include <boost/python.hpp>
#include <core/Body.hpp>
#include <core/BodyContainer.hpp>
#include <core/Cell.hpp>
#include <core/Clump.hpp>
#include <core/Engine.hpp>
#include <core/ForceContainer.hpp>
#include <core/Functor.hpp>
#include <core/Interaction.hpp>
#include <core/Omega.hpp>
#include <core/Scene.hpp>
#include <core/State.hpp>
#include <lib/factory/ClassFactory.hpp>
#include <pkg/common/Aabb.hpp>
#include <pkg/common/Dispatching.hpp>
#include <pkg/common/ElastMat.hpp>
#include <pkg/common/NormShearPhys.hpp>
#include <pkg/common/PeriodicEngines.hpp>
#include <pkg/common/Sphere.hpp>
#include <pkg/dem/ScGeom.hpp>

#include "engines/base/real.hpp"
#else
#include "engines/seam/yade_classes.hpp"
#endif
