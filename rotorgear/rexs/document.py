"""What a REXS file holds: components with attributes, relations between them, load cases."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Value:
    """A value as it stands in the file: text, number, truth or a list of them, and the text of its unit."""

    raw: object
    unit: str = ""


@dataclass(frozen=True)
class Component:
    """A component: its number, type, name and attributes."""

    id: str
    type: str
    name: str
    attributes: dict[str, Value] = field(default_factory=dict)

    def __str__(self) -> str:
        return f"{self.type} '{self.name}' (id {self.id})" if self.name else f"{self.type} (id {self.id})"


@dataclass(frozen=True)
class Relation:
    """A relation: its type, and role and component of each that takes part."""

    type: str
    refs: tuple[tuple[str, str], ...]

    def at(self, *roles: str) -> list[str]:
        """Numbers of the components in one of these roles."""
        return [number for role, number in self.refs if role in roles]


@dataclass(frozen=True)
class Document:
    """A file: version, program that wrote it, components by number, relations, and load cases: attributes by component."""

    version: str
    application: str
    components: dict[str, Component]
    relations: tuple[Relation, ...]
    load_cases: tuple[tuple[str, dict[str, dict[str, Value]]], ...] = ()

    def of_type(self, *types: str) -> list[Component]:
        """The components of some types, in the order of the file."""
        return [component for component in self.components.values() if component.type in types]
