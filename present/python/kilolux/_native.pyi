# SPDX-License-Identifier: Apache-2.0
"""The compiled half. Its functions take what the modules beside it have put into shape."""
from typing import Any

class Error(RuntimeError):
    """What the command line would say, in one line: what, where, the value seen."""

def version() -> str:
    """The program's version."""

def devices() -> list[str]:
    """Names of the OpenCL devices, in the order that the option `device` counts."""

def __getattr__(name: str) -> Any: ...
