"""Reads means of the forces on a body among disks over a block of steps from its `ContactForceBinner`."""

from ..scenes import scene
from ..base.errors import UsageError


def block_means(binner):
    """Return the means of a ContactForceBinner on a body among disks since it was last cleared, as a dict, and clear it.

    fx, fy, normal_x (of the normal forces alone) [N], torque [N m], contacts, slipping; variances of the instantaneous
    values within the block, fx_var, fy_var [N^2], contacts_var; by angle, shape (bins,): normal, tangential [N],
    contacts_by_angle, slipping_by_angle. UsageError on a GrainLoop of spheres, whose forces have a third component.
    """
    loop = scene.fast_loop()
    if loop and loop.dimensions == 3:
        raise UsageError(
            "block_means records forces in the plane, and this scene is one of spheres; read the binner's own force,"
            " torque, ... (x, y, z)"
        )
    force, variance = binner.force, binner.forceVariance
    row = dict(
        fx=force[0],
        fy=force[1],
        normal_x=binner.normalForceOnBody[0],
        torque=binner.torque[2],
        contacts=binner.contactNumber,
        slipping=binner.slippingNumber,
        fx_var=variance[0],
        fy_var=variance[1],
        contacts_var=binner.contactNumberVariance,
        normal=binner.normalForce,
        tangential=binner.tangentialForce,
        contacts_by_angle=binner.contacts,
        slipping_by_angle=binner.slippingContacts,
    )
    binner.clear()
    return row
