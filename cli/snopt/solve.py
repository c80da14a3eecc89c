"""Solves a program with the SNOPT in Drake's wheel, for `prowl compare --solver snopt`, which evaluates it (cli/drake_snopt.cpp).

Over stdin and stdout, in the machine's own binary numbers; n variables, m constraints, k places of the Jacobian:

    here:    one byte "!" once Drake is loaded
    Prowl:   4 int64 (n, m, k, most major iterations), double tolerance, doubles start (n), lower (n), upper (n), row_lower (m),
             row_upper (m), int32 rows (k), columns (k)
    here:    "e" and z (n): what is the program there?
    Prowl:   double 0 if it cannot be evaluated; else 1, cost, gradient (n), rows (m), jacobian (k)
    ...
    here:    "r", a line of JSON, z (n), and if has_multipliers those (m)

Exit status 3: a library is missing.
"""

import json
import os
import signal
import struct
import sys
import time
from pathlib import Path
from typing import BinaryIO

sys.path.insert(0, str(Path(__file__).resolve().parent))

try:
    import _drake_snopt as snopt
    import numpy as np
    import pydrake.solvers  # noqa: F401
except ModuleNotFoundError:
    sys.exit(3)  # Prowl says what to install


class Line:
    """Our end of the talk."""

    def __init__(self) -> None:
        self.input: BinaryIO = os.fdopen(os.dup(0), "rb")
        self.output: BinaryIO = os.fdopen(os.dup(1), "wb")
        os.dup2(2, 1)  # what a library prints is for people

    def receive(self, count: int, kind: str = "float64") -> np.ndarray:
        data = self.input.read(count * np.dtype(kind).itemsize)
        if len(data) != count * np.dtype(kind).itemsize:
            raise EOFError("Prowl has gone")
        return np.frombuffer(data, dtype=kind)

    def send(self, *parts: bytes) -> None:
        for part in parts:
            self.output.write(part)
        self.output.flush()


def read_program(line: Line) -> tuple[snopt.Program, float, int]:
    n, m, k, max_iterations = struct.unpack("4q", line.input.read(32))
    tolerance = float(line.receive(1)[0])

    def evaluate(z: np.ndarray) -> snopt.Evaluation:
        line.send(b"e", z.tobytes())
        if line.receive(1)[0] == 0.0:
            raise ArithmeticError("an evaluation failed")
        return snopt.Evaluation(float(line.receive(1)[0]), line.receive(n), line.receive(m), line.receive(k))

    start, lower, upper, row_lower, row_upper = (line.receive(size) for size in (n, n, n, m, m))
    pattern = (line.receive(k, "int32"), line.receive(k, "int32"))
    return snopt.Program(start, lower, upper, row_lower, row_upper, pattern, evaluate), tolerance, max_iterations


def main() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is Prowl's to handle
    line = Line()
    line.send(b"!")
    program, tolerance, max_iterations = read_program(line)
    begin = time.process_time()
    found = snopt.minimise(program, tolerance=tolerance, max_iterations=max_iterations, max_seconds=float("inf"))
    told = {
        "status": found.status,
        "message": found.message,
        "iterations": found.iterations,
        "cpu_seconds": time.process_time() - begin,
        "has_multipliers": found.multipliers is not None,
    }
    multipliers = b"" if found.multipliers is None else np.ascontiguousarray(found.multipliers).tobytes()
    line.send(b"r", json.dumps(told).encode(), b"\n", np.ascontiguousarray(found.z).tobytes(), multipliers)


if __name__ == "__main__":
    try:
        main()
    except (EOFError, BrokenPipeError):
        sys.exit(1)
