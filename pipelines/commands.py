"""The pipelines that are sub-commands of scratchwarp."""

from . import author
from .command import Command

COMMANDS: dict[str, Command] = {module.COMMAND.name: module.COMMAND for module in (author,)}
