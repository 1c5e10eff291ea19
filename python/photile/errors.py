"""Errors. Each message is one line: what was found, and the remedy."""

__all__ = [
    "Error",
    "UsageError",
    "InputError",
    "OutputError",
    "DeviceError",
    "DeviceMemoryError",
    "KernelBuildError",
]


class Error(Exception):
    """Base of every error that photile raises on purpose."""


class UsageError(Error, ValueError):
    """A parameter is out of its range, or names something that does not exist."""


class InputError(Error, ValueError):
    """A file, an array or a scene cannot be used."""


class OutputError(Error, OSError):
    """An output cannot be written."""


class DeviceError(Error, RuntimeError):
    """An OpenCL call failed, or there is no such device."""


class DeviceMemoryError(DeviceError, MemoryError):
    """The device's memory does not suffice."""


class KernelBuildError(DeviceError):
    """A kernel did not compile.

    Attributes
    ----------
    build_log : str
        The output of the compiler of the OpenCL runtime.
    """

    build_log: str = ""
