"""The same tip angle by what people use today: scipy's solve_bvp and solve_ivp, and AUTO-07p through bifpy.

    phi'' + lam sin(phi) = 0,   phi(0) = 0,   phi'(1) = 0        y = (phi, phi'), K = 1, the guess that all methods have

solve_bvp    collocation of order 4 on a mesh of its own, to a tolerance of its residual [Kierzenka and Shampine 2001]
solve_ivp    shooting from the tip with psi = d phi / d phi(1) beside it, Newton's method on phi(0) = 0
AUTO         collocation of order 2 NCOL on NTST intervals, compiled with gfortran. It follows branches, so that its way is:
             trivial branch, branch point of the mode, switch, the branch to lam: two runs of its program
             [Doedel et al., AUTO-07p]

AUTO's files hold 11 digits: the tip's angle is written in two parts, to a millionth and the rest, and loses none.
"""

import importlib.util
import math
import re
import shutil
import subprocess
import tempfile
import weakref
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import root_scalar

from rodlab.lab.studies.asked import Found, Method, Question
from rodlab.lab.studies.other_methods import NOTHING, Posed, elastica_system, landed, posed, refused
from rodlab.numerics.arrays import Array

FIRST = 11  # points of solve_bvp's first mesh
MOST = 10_000  # and of its last
PATIENCE = 60.0  # seconds for one run of AUTO

MODEL = """
SUBROUTINE FUNC(NDIM,U,ICP,PAR,IJAC,F,DFDU,DFDP)
  IMPLICIT DOUBLE PRECISION (A-H,O-Z)
  DIMENSION U(NDIM),PAR(*),F(NDIM),ICP(*),DFDU(NDIM,NDIM),DFDP(NDIM,*)
  F(1) = U(2); F(2) = -PAR(1)*SIN(U(1))
  IF (IJAC==0) RETURN
  DFDU(1,1) = 0; DFDU(1,2) = 1; DFDU(2,1) = -PAR(1)*COS(U(1)); DFDU(2,2) = 0
  IF (IJAC==1) RETURN
  DFDP(1,1) = 0; DFDP(2,1) = -SIN(U(1))
END
SUBROUTINE BCND(NDIM,PAR,ICP,NBC,U0,U1,FB,IJAC,DBC)
  IMPLICIT DOUBLE PRECISION (A-H,O-Z)
  DIMENSION PAR(*),ICP(*),U0(NDIM),U1(NDIM),FB(NBC),DBC(NBC,*)
  FB(1) = U0(1); FB(2) = U1(2)
  IF (IJAC==0) RETURN
  DBC(:,1:4) = 0; DBC(1,1) = 1; DBC(2,4) = 1
  IF (IJAC==2) DBC(:,5) = 0
END
SUBROUTINE PVLS(NDIM,U,PAR)
  INTEGER NDIM
  DOUBLE PRECISION U(NDIM),PAR(*),TIP
  DOUBLE PRECISION, EXTERNAL :: GETP
  TIP = SIGN(GETP('BV1',1,U), GETP('BV1',1,U)*GETP('BV0',2,U))
  PAR(2) = ANINT(TIP*1D6)/1D6; PAR(3) = TIP - PAR(2)
END
SUBROUTINE STPNT(NDIM,U,PAR,T)
  DOUBLE PRECISION U(NDIM),PAR(*),T
  PAR(1) = 0; U = 0
END
SUBROUTINE ICND
END
SUBROUTINE FOPT
END
"""
COMMON = "NDIM=2, IPS=4, ILP=0, ICP=[1,2,3], NPAR=3, IPLT=1, NBC=2, NINT=0, NPR=0, IID=0, ITMX=9, JAC=1, DSMIN=1e-5, IADS=1\n"
TRIVIAL = (
    "IRS=0, NTST={ntst}, NCOL={ncol}, IAD=0, ISP=2, ISW=1, NMX=500, ITNW=5, NWTN={nwtn}, EPSL=1e-7, EPSU=1e-7, EPSS=1e-5,"
    " DS=1.25, DSMAX=1.25, RL1={beyond}, STOP=['BP{mode}']\n"
)
BRANCH = (
    "IRS='BP{mode}', NTST={ntst}, NCOL={ncol}, IAD={iad}, ISP=0, ISW=-1, NMX=500, ITNW={itnw}, NWTN={nwtn}, EPSL={epsl},"
    " EPSU={epsl}, EPSS={epss}, DS={ds}, DSMAX={dsmax}, THL={{1:{thl}}}, THU={{2:{thu}}}, UZSTOP={{1:{lam!r}}}\n"
)


# --- AUTO -------------------------------------------------------------------------------------------------------------


class AutoSettings(NamedTuple):
    """AUTO's constants of the buckled branch, by its own names; those of a careful user."""

    ntst: int
    ncol: int = 4
    iad: int = 0
    itnw: int = 5
    nwtn: int = 3
    epsl: float = 1e-9
    epss: float = 1e-12
    ds: float = 1.0
    dsmax: float = 1.0
    thl: float = 1
    thu: float = 1


class AutoRun(NamedTuple):
    """Where AUTO ended: load, tip angle, its points on the branch, its own seconds, and a note if the branch is another."""

    lam: float
    tip_angle: float
    points: int
    seconds: float
    note: str = ""


class Auto:
    """AUTO's program for the elastica, compiled into a folder of its own, which goes with it or with `close`.

    Raises `RuntimeError` where it cannot be compiled, with the compiler's last words.
    """

    def __init__(self) -> None:
        why = auto_missing()
        if why:
            raise RuntimeError(why)
        self.folder = Path(tempfile.mkdtemp(prefix="rodlab-auto-"))
        self.close = weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        source, library, self.program = self.folder / "elastica.f90", _library(), self.folder / "elastica"
        source.write_text(MODEL)
        parts = [source, library / "main.o", library / "libbifpy.a", "-o", self.program]
        done = self._call(["gfortran", "-O3", *map(str, parts)])
        if done.returncode:
            raise RuntimeError(f"AUTO: gfortran could not link bifpy's library: {done.stderr.strip()[-200:]}")

    def follow(self, lam: float, settings: AutoSettings, mode: int = 1) -> AutoRun:
        """The tip angle of a mode at lam (K = 1): trivial branch, branch point, switch, branch. Raises `ArithmeticError`."""
        least = ((2 * mode - 1) * math.pi / 2) ** 2
        constants: dict[str, Any] = {**settings._asdict(), "mode": mode, "beyond": 1.25 * least, "lam": lam}
        first = self._run(TRIVIAL.format(**constants))
        (self.folder / "fort.8").replace(self.folder / "fort.3")
        (self.folder / "fort.7").unlink()
        second = self._run(BRANCH.format(**constants))
        rows = [line.split() for line in (self.folder / "fort.7").read_text().splitlines() if not line.startswith("   0")]
        start, end = float(rows[0][4]), rows[-1]
        if end[2] != "-4":
            raise ArithmeticError(f"AUTO ended at {float(end[4]):g} with type {end[2]}, not at the load asked for")
        known = 0.9 * least < start < 1.1 * least
        note = "" if known else f"wrong: AUTO's branch point {mode} is at {start:g}, the mode's is at {least:g}"
        return AutoRun(float(end[4]), float(end[-2]) + float(end[-1]), len(rows), first + second, note)

    def _run(self, constants: str) -> float:
        (self.folder / "fort.2").write_text(COMMON + constants)
        done = self._call([str(self.program)])
        if done.returncode:
            raise ArithmeticError(f"AUTO's program failed: {done.stderr.strip()[-200:]}")
        return sum(map(float, re.findall(r"Total Time\s+(\S+)", done.stdout)))

    def _call(self, command: list[str]) -> "subprocess.CompletedProcess[str]":
        return subprocess.run(  # noqa: S603  our own program
            command, cwd=self.folder, capture_output=True, text=True, check=False, timeout=PATIENCE, stdin=subprocess.DEVNULL
        )


def _library() -> Path:
    spec = importlib.util.find_spec("bifpy")
    return Path(*(spec.submodule_search_locations or ()) if spec else (), "auto", "_lib")


def auto_missing() -> str:
    """Why AUTO cannot run here, in a sentence; empty where it can."""
    if importlib.util.find_spec("bifpy") is None:
        return "AUTO: left out, bifpy is not installed (pip install bifpy, and gfortran)"
    if shutil.which("gfortran") is None:
        return "AUTO: left out, gfortran is not installed (apt-get install gfortran)"
    if not all((_library() / part).is_file() for part in ("main.o", "libbifpy.a")):
        return "AUTO: left out, this bifpy holds no compiled library to link"
    return ""


def _compiled(question: Question, size: float) -> tuple[Posed, Auto, AutoSettings]:
    asked = posed(question)
    first = 0.4 * asked.amplitude * math.hypot(1, asked.wave) / math.sqrt(2)  # of the guess: AUTO sees no stop in its first step
    return asked, Auto(), AutoSettings(int(size), ds=first, dsmax=max(first, asked.lam / 5))


def _followed(_: Question, given: tuple[Posed, Auto, AutoSettings]) -> Found:
    asked, program, settings = given
    try:
        run = program.follow(asked.lam, settings, asked.mode)
    except (ArithmeticError, subprocess.TimeoutExpired) as error:
        return refused(error)
    note = run.note or f"AUTO's own time {run.seconds:.4g} s, {run.points} points"
    if not run.note and not run.tip_angle * asked.sign() > NOTHING * asked.amplitude:
        note = "wrong: left the branch of its mode"
    return Found(run.tip_angle, math.inf, 2 * settings.ntst * settings.ncol + 2, note)


# --- scipy ------------------------------------------------------------------------------------------------------------


class _Guessed(NamedTuple):
    asked: Posed
    tol: float
    mesh: Array
    guess: Array


def _guessed(question: Question, tol: float) -> _Guessed:
    asked, mesh = posed(question), np.linspace(0, 1, FIRST)
    return _Guessed(asked, tol, mesh, asked.guess(mesh))


def _bvp(_: Question, given: _Guessed) -> Found:
    system, by_ends = elastica_system(given.asked.lam), (np.diag([1.0, 0.0]), np.diag([0.0, 1.0]))

    def ends(a: Array, b: Array) -> Array:
        return np.array([a[0], b[1]])

    def slopes(_a: Array, _b: Array) -> tuple[Array, Array]:
        return by_ends

    found = solve_bvp(system.f, ends, given.mesh, given.guess, fun_jac=system.df, bc_jac=slopes, tol=given.tol, max_nodes=MOST)
    value, note = landed(given.asked, found.y[0], float(found.y[1, 0]))
    note = f"{note}, with status {found.status}" if note else "" if found.success else f"refused: {found.message}"
    return Found(value, math.inf, found.y.size, note)


def _ivp(_: Question, given: _Guessed) -> Found:
    """Newton's method as scipy has it; `unknowns` are the evaluations of the right-hand side, times the four variables."""
    asked, tol, runs = given.asked, given.tol, []

    def slopes(_s: float, y: Array) -> list[float]:
        return [y[1], -asked.lam * math.sin(y[0]), y[3], -asked.lam * math.cos(y[0]) * y[2]]

    def missed(a: float) -> tuple[float, float]:
        runs.append(solve_ivp(slopes, (1, 0), [a, 0, 1, 0], method="DOP853", rtol=tol, atol=tol))
        return runs[-1].y[0, -1], runs[-1].y[2, -1]

    root = root_scalar(missed, x0=float(given.guess[0, -1]), fprime=True, method="newton", xtol=tol)
    if not root.converged:
        return refused(f"Newton's method did not converge: {root.flag}")
    phi, slope = runs[-1].y[0, ::-1].copy(), float(runs[-1].y[1, -1])
    phi[0], phi[-1] = 0.0, root.root
    value, note = landed(asked, phi, slope)
    return Found(value, math.inf, 4 * sum(run.nfev for run in runs), note)


def peers() -> list[Method]:
    """scipy's two ways and AUTO; where AUTO cannot run it is there, and says why."""
    tols = tuple(10.0**-i for i in range(2, 13))
    shots = tuple(10.0**-i for i in range(4, 14))
    return [
        Method("scipy solve_bvp", None, tols, tols[::4], _guessed, _bvp),
        Method("scipy solve_ivp, shooting, DOP853", None, shots, shots[::4], _guessed, _ivp),
        Method("AUTO, NCOL=4", 8, (5.0, 10.0, 20.0, 40.0, 80.0), (5.0, 10.0), _compiled, _followed, auto_missing()),
    ]
