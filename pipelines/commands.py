"""The pipelines that are sub-commands of scratchwarp."""

from . import author, compare, contact_sheet, publish, turntable, zoom
from .command import Command

PIPELINES = (author, compare, contact_sheet, publish, turntable, zoom)
COMMANDS: dict[str, Command] = {module.COMMAND.name: module.COMMAND for module in PIPELINES}
