#!/usr/bin/python3
"""Executes every notebook of notebooks-data: from first cell to last, in a copy of that folder's
tables, without errors, each with at least one picture and one table.

A notebook whose table is not published is executed on the tables of a quick run.

Usage: test_notebooks.py SOURCE_DIR PROGRAM
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

try:
    import ipykernel  # noqa: F401: the kernel that runs them
    import matplotlib  # noqa: F401
    import nbclient
    import nbformat
    import pandas  # noqa: F401
except ImportError as missing:
    print(f"SKIPPED: {missing.name} is not installed")
    sys.exit(0)


def execute(path, folder):
    """Returns why the notebook is wrong, or nothing."""
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    if any(cell.get("outputs") for cell in notebook.cells):
        return "has outputs: they are not committed, since they would not follow the tables"
    try:
        nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3",
                                resources={"metadata": {"path": str(folder)}}).execute()
    except nbclient.exceptions.CellExecutionError as error:
        return str(error)
    shown = [kind for cell in notebook.cells for output in cell.get("outputs", [])
             for kind in output.get("data", {})]
    missing = {"image/png", "text/html"} - set(shown)
    return f"shows no {' and no '.join(sorted(missing))}" if missing else None


def main(source_dir, program):
    data = pathlib.Path(source_dir) / "notebooks-data"
    notebooks = sorted(data.glob("*.ipynb"))
    wrong = ["no notebooks"] if not notebooks else []
    with tempfile.TemporaryDirectory() as name:
        # The copy has tables and manifests alone: a notebook that reads anything else fails.
        for pattern in ("*.csv", "*.json"):
            for table in data.glob(pattern):
                shutil.copy(table, name)
        if not (data / "parameter_sweeps.csv").exists():
            subprocess.run([program, "experiment", "run", "parameter_sweeps", "--quick", "--quiet",
                            "--out", name], check=True)
            print("parameter_sweeps is not published: its notebook runs on a quick run's tables")
        for path in notebooks:
            why = execute(path, name)
            print(f"{path.name}: {why or 'executed'}", flush=True)
            wrong += [why] if why else []
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2]))
