"""Runs OpenFOAM's `interFoam` on a drum half full of a Newtonian fluid: writes the case, runs it, reads its last state.

The mesh consists of the squares whose centres lie in the drum, and every face of its wall has the velocity of a rigidly rotating
solid, also normal to the face. A mesh that follows the circle cannot be used with Debian 12's package `openfoam`
(1912.200626-1+b1): on inclined faces its reconstruction of velocities from fluxes, in `interFoam` and `potentialFoam`, gives
every other cell a wrong component. On a slanted mesh `potentialFoam` returns a uniform flow (1, 0) as (0.97, 3.98) in the second
cell, and `interFoam` diverges within ten steps for any time step, also without gravity and with one fluid. With this fault
corrected, a mesh of 40 cells across that followed the circle had the same error as this one, 5.1 and 5.2 % in u(z) at
t = 15 sqrt(R/g): the error comes from the surface, not from the wall.
"""

import os
import re
import resource
import shutil
import subprocess
from pathlib import Path

import numpy as np

ETC = Path("/usr/share/openfoam")  # where Debian keeps what OpenFOAM's programs read
PROGRAM = "interFoam"
THICKNESS = 0.1  # of the one layer of cells, in radii

HEADER = "FoamFile {{ version 2.0; format ascii; class {kind}; object {name}; }}\n"

CONTROL = """application interFoam;
startFrom startTime; startTime 0; stopAt endTime; endTime {end};
deltaT {dt}; adjustTimeStep no; maxCo 1; maxAlphaCo 1; maxDeltaT 1;
writeControl runTime; writeInterval {end}; writeFormat ascii; writePrecision 12; timePrecision 12; runTimeModifiable no;
"""

SCHEMES = """ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes
{
    default none;
    div(rhoPhi,U) Gauss linear;
    div(phi,alpha) Gauss vanLeer;
    div(phirb,alpha) Gauss linear;
    div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;
}
laplacianSchemes { default Gauss linear orthogonal; }
interpolationSchemes { default linear; }
snGradSchemes { default orthogonal; }
"""

SOLUTION = """solvers
{{
    "alpha.bed.*"
    {{
        nAlphaCorr 2; nAlphaSubCycles 1; cAlpha {compression}; MULESCorr yes; nLimiterIter 3;
        solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0;
    }}
    "pcorr.*" {{ solver PCG; preconditioner DIC; tolerance 1e-8; relTol 0; }}
    p_rgh {{ solver GAMG; smoother DIC; tolerance {tolerance}; relTol 0.05; }}
    p_rghFinal {{ $p_rgh; relTol 0; }}
    "U.*" {{ solver smoothSolver; smoother symGaussSeidel; tolerance 1e-8; relTol 0; }}
}}
PIMPLE
{{
    momentumPredictor yes; nOuterCorrectors 1; nCorrectors {corrections}; nNonOrthogonalCorrectors 0;
    pRefCell {in_gas}; pRefValue 0;
}}
"""

# Almost at rest: interFoam compares the flow through the wall with the initial fluxes, which must not be zero.
SPEED = """dimensions [0 1 -1 0 0 0 0];
internalField uniform ({creep:.3g} 0 0);
boundaryField
{{
    wall {{ type fixedValue; value nonuniform {wall}; }}
    sides {{ type empty; }}
}}
"""

PRESSURE = """dimensions [1 -1 -2 0 0 0 0];
internalField uniform 0;
boundaryField { wall { type fixedFluxPressure; value uniform 0; } sides { type empty; } }
"""

FRACTION = """dimensions [0 0 0 0 0 0 0];
internalField nonuniform {fraction};
boundaryField {{ wall {{ type zeroGradient; }} sides {{ type empty; }} }}
"""

FLUIDS = """phases (bed gas);
bed {{ transportModel Newtonian; nu {nu}; rho {density}; }}
gas {{ transportModel Newtonian; nu {gas_nu}; rho {gas_density}; }}
sigma 0;
"""


def available():
    """Return whether interFoam is installed, by Debian's package or with an environment of its own."""
    return shutil.which(PROGRAM) is not None and ("WM_PROJECT_DIR" in os.environ or (ETC / "etc").is_dir())


# ---- the mesh --------------------------------------------------------------------------------------------------------


class Mesh:
    """Squares whose centres lie in a circle, `cells` across it, in one layer of a thickness of 0.1 radii.

    `x` and `y` are the centres along either axis, (cells,); `inside` tells which squares are cells, (cells, cells), rows of y;
    `walls` are the centres of the wall's faces, (faces, 2). ValueError for an odd number, which would put the level within cells.
    """

    def __init__(self, radius, cells):
        if cells % 2 or cells < 4:
            raise ValueError(f"cells across the drum must be an even number from 4 on, got {cells}")
        self.radius, self.cells = radius, cells
        self.spacing = 2 * radius / cells
        self.x = self.y = (np.arange(cells) + 0.5) * self.spacing - radius
        self.inside = np.hypot(self.x, self.y[:, None]) < radius
        self.faces = self.sort_faces()
        self.walls = np.array([middle for middle, _, _ in self.faces["wall"]])

    def sort_faces(self):
        """Return {"between", "wall", "flat": [(middle, corners, cells beside it)]}, in the order that OpenFOAM asks for."""
        number = np.full((self.cells + 2, self.cells + 2), -1)  # with a margin in which there are no cells
        number[1:-1, 1:-1][self.inside] = np.arange(self.inside.sum())
        corner = np.arange((self.cells + 1) ** 2).reshape(self.cells + 1, -1)
        opposite = corner.size  # what a corner's partner on the layer's other side has more
        found = dict(between=[], wall=[], flat=[])
        for row, column in np.argwhere(self.inside):
            own = number[row + 1, column + 1]
            a, b, c, d = corner[[row, row, row + 1, row + 1], [column, column + 1, column + 1, column]]
            middle = np.array([self.x[column], self.y[row]])
            for ends, right, up in (((b, c), 1, 0), ((c, d), 0, 1), ((d, a), -1, 0), ((a, b), 0, -1)):
                other = number[row + 1 + up, column + 1 + right]
                corners = (*ends, ends[1] + opposite, ends[0] + opposite)
                at = middle + np.array([right, up]) * self.spacing / 2
                if other < 0:
                    found["wall"].append((at, corners, (own,)))
                elif other > own:
                    found["between"].append((at, corners, (own, other)))
            found["flat"].append((middle, (a, d, c, b), (own,)))
            found["flat"].append((middle, tuple(k + opposite for k in (a, b, c, d)), (own,)))
        return found

    def write(self, folder):
        """Write constant/polyMesh."""
        ticks = np.arange(self.cells + 1) * self.spacing - self.radius
        depth = THICKNESS * self.radius
        every = [face for kind in ("between", "wall", "flat") for face in self.faces[kind]]
        between, wall, flat = (len(self.faces[kind]) for kind in ("between", "wall", "flat"))
        patches = [
            f"wall {{ type wall; nFaces {wall}; startFace {between}; }}",
            f"sides {{ type empty; nFaces {flat}; startFace {between + wall}; }}",
        ]
        parts = dict(
            points=("vectorField", [vector(x, y, z) for z in (0, depth) for y in ticks for x in ticks]),
            faces=("faceList", [f"4({' '.join(map(str, corners))})" for _, corners, _ in every]),
            owner=("labelList", [str(beside[0]) for _, _, beside in every]),
            neighbour=("labelList", [str(beside[1]) for _, _, beside in self.faces["between"]]),
            boundary=("polyBoundaryMesh", patches),
        )
        for name, (kind, entries) in parts.items():
            write_file(folder, f"constant/polyMesh/{name}", kind, listed(entries) + "\n")

    def on_squares(self, values):
        """Return values in cells (n, ...) on all squares, (cells, cells, ...); nan where there is no cell."""
        full = np.full((*self.inside.shape, *values.shape[1:]), np.nan)
        full[self.inside] = values
        return full


def vector(*numbers):
    """Return a vector in OpenFOAM's syntax."""
    return f"({' '.join(f'{number:.15g}' for number in numbers)})"


def listed(entries):
    """Return a list in OpenFOAM's syntax."""
    return f"{len(entries)}\n(\n" + "\n".join(entries) + "\n)"


def write_file(folder, name, kind, text):
    """Write one file of a case, after the header of its kind."""
    path = Path(folder) / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(kind=kind, name=path.name) + text)


# ---- the case --------------------------------------------------------------------------------------------------------


def write(folder, drum, cells, dt, end, corrections=3, tolerance=1e-8, compression=1):
    """Write a case of a `drum` that begins at rest, half full, its surface level; return its `Mesh`.

    `drum` has radius, spin, viscosity, density, gas_viscosity, gas_density and gravity, in units that fit each other; `dt` and
    `end` are times; `corrections` is how often a step solves for the pressure, `compression` interFoam's cAlpha.
    """
    mesh = Mesh(drum["radius"], cells)
    mesh.write(folder)
    spin, radius = drum["spin"], drum["radius"]
    wall = listed([vector(-spin * y, spin * x, 0) for x, y in mesh.walls])
    filled = np.repeat(mesh.y[:, None] < 0, cells, axis=1)[mesh.inside]
    solution = dict(compression=compression, tolerance=tolerance, corrections=corrections, in_gas=mesh.inside.sum() - 1)
    fluids = dict(nu=drum["viscosity"] / drum["density"], gas_nu=drum["gas_viscosity"] / drum["gas_density"])
    fluids.update(density=drum["density"], gas_density=drum["gas_density"])
    for name, text in {
        "system/controlDict": CONTROL.format(dt=dt, end=end),
        "system/fvSchemes": SCHEMES,
        "system/fvSolution": SOLUTION.format(**solution),
        "constant/transportProperties": FLUIDS.format(**fluids),
        "constant/turbulenceProperties": "simulationType laminar;\n",
    }.items():
        write_file(folder, name, "dictionary", text)
    gravity = f"dimensions [0 1 -2 0 0 0 0];\nvalue {vector(0, -drum['gravity'], 0)};\n"
    write_file(folder, "constant/g", "uniformDimensionedVectorField", gravity)
    speed = SPEED.format(creep=1e-6 * spin * radius, wall=f"List<vector> {wall}")
    write_file(folder, "0/U", "volVectorField", speed)
    write_file(folder, "0/p_rgh", "volScalarField", PRESSURE)
    fraction = FRACTION.format(fraction="List<scalar> " + listed([str(int(full)) for full in filled]))
    write_file(folder, "0/alpha.bed", "volScalarField", fraction)
    return mesh


def run(folder):
    """Run a case that `write` left in a folder on one core; return its processor time [s].

    RuntimeError with interFoam's last output if it fails.
    """
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    log = Path(folder) / f"{PROGRAM}.log"
    surroundings = {"WM_PROJECT_DIR": str(ETC), **os.environ, "PWD": str(Path(folder).resolve())}
    with open(log, "w") as words:
        done = subprocess.run([PROGRAM], cwd=folder, env=surroundings, stdout=words, stderr=subprocess.STDOUT)
    if done.returncode:
        said = [line for line in log.read_text().splitlines() if line.strip()][-3:]
        raise RuntimeError(f"{PROGRAM} failed: {said}; its case is {folder}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def state(folder, mesh):
    """Return the last state on the mesh's squares: fraction (cells, cells) and velocity (cells, cells, 2); nan outside."""
    times = [path for path in Path(folder).iterdir() if re.fullmatch(r"[\d.]+(e[-+]?\d+)?", path.name)]
    last = max(times, key=lambda path: float(path.name))
    return mesh.on_squares(numbers(last / "alpha.bed")), mesh.on_squares(numbers(last / "U")[:, :2])


def numbers(path):
    """Return a field's values in the cells from OpenFOAM's text, (cells,) or (cells, 3)."""
    text = path.read_text()
    start = text.index("internalField")
    count = re.compile(r"nonuniform List<\w+>\s*(\d+)\s*\(").search(text, start)
    if count is None:
        raise ValueError(f"{path} must hold a number for every cell, but its field is uniform")
    body = text[count.end() : text.index("\n)", count.end())]
    return np.array(re.sub(r"[()]", " ", body).split(), dtype=float).reshape(int(count[1]), -1).squeeze()
