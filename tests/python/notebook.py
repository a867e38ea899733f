"""Runs a notebook and writes it with its outputs elsewhere: notebook.py FROM TO."""

import sys
from pathlib import Path

import nbclient
import nbformat

source, target = map(Path, sys.argv[1:])
book = nbformat.read(source, as_version=4)
kept = [cell for cell in book.cells if cell.cell_type == "code" and (cell.outputs or cell.execution_count)]
if kept:
    sys.exit(f"{source}: clear its outputs before it is committed")
nbclient.NotebookClient(book, timeout=300, resources={"metadata": {"path": str(source.parent)}}).execute()
nbformat.write(book, target)
shown = sum("image/png" in output.get("data", {}) for cell in book.cells for output in cell.get("outputs", []))
print(f"notebook: {len(book.cells)} cells, {shown} pictures")
