"""Contact of the sheet with rigid obstacles, an item of the lattice each."""

from lumped.contact.contact import Contact, contact_pressure, contacts
from lumped.contact.penalties import ContactPenalties

__all__ = ["Contact", "ContactPenalties", "contact_pressure", "contacts"]
