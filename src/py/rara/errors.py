"""The exceptions of the package. Each message is one or two sentences that say what is wrong and what to do."""


class Error(Exception):
    """An error of rara."""


class IoError(Error, OSError):
    """A file could not be opened, read or written."""


class FormatError(Error, ValueError):
    """A file was read, but its content cannot be used."""


class InvalidError(Error, ValueError):
    """An argument is not possible; the message begins with its name."""


class DeviceError(Error, RuntimeError):
    """No Vulkan device can be used: there is no loader, no driver or no device with the required features."""


class DeviceLostError(DeviceError):
    """The device was lost. Make another renderer."""


class VulkanError(DeviceError):
    """A Vulkan call failed."""


class OutOfMemoryError(Error, MemoryError):
    """The host or the device does not have enough free memory."""


class BudgetError(OutOfMemoryError):
    """The request would take more device memory than is allowed."""


class ValidationError(Error, RuntimeError):
    """The validation layer reported something."""
